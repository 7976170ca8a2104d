# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender with a window: walks through edits and writes what the 3D View showed.

blender --factory-startup -P viewport_steps.py -- OUT.json
"""

import gc
import json
import os
import sys
import time
import traceback

import bpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(
    os.path.abspath(__file__)))), 'addon'))

import panoptes  # noqa: E402
from panoptes import native, session  # noqa: E402
from panoptes.viewport import Viewport  # noqa: E402

OUT = sys.argv[sys.argv.index('--') + 1]
LIMIT = 60.0

shown = {}


def area(kind):
    screen = bpy.context.window_manager.windows[0].screen
    return next(a for a in screen.areas if a.type == kind)


def viewport():
    """Return the newest `Viewport` that has not been freed."""
    found = [thing for thing in gc.get_objects() if type(thing) is Viewport]
    return found[-1] if found else None


def background():
    return next(n for n in bpy.context.scene.world.node_tree.nodes if n.type == 'BACKGROUND')


def picture():
    """Return (mean colour, width, height) of the last picture, or None while it is not done."""
    view = viewport()
    if view is None or view.is_rendering() or view._pixels is None:
        return None
    height, width = view._pixels.shape[:2]
    return [*map(float, view._pixels[..., :3].mean(axis=(0, 1))), width, height]


def start():
    panoptes.register()
    scene = bpy.context.scene
    scene.render.engine = 'PANOPTES'
    scene.panoptes.viewport_samples = 4
    scene.panoptes.samples = 2
    scene.render.resolution_x, scene.render.resolution_y = 64, 48
    for thing in list(scene.objects):
        if thing.type != 'CAMERA':
            bpy.data.objects.remove(thing)
    scene.world.use_nodes = True
    background().inputs['Color'].default_value = (0.0, 0.5, 0.0, 1.0)
    area('PROPERTIES').spaces[0].context = 'RENDER'
    area('VIEW_3D').spaces[0].shading.type = 'RENDERED'


def edit_world():
    background().inputs['Color'].default_value = (0.0, 0.0, 1.0, 1.0)


def add_plane():
    bpy.ops.mesh.primitive_plane_add(size=1000)


def turn_view():
    area('VIEW_3D').spaces[0].region_3d.view_distance = 3.0
    area('VIEW_3D').spaces[0].region_3d.view_rotation = (1.0, 0.0, 0.0, 0.0)


def final_render():
    session.start_final()
    bpy.ops.render.render('INVOKE_DEFAULT')


def final_result():
    text = bpy.context.scene.panoptes.last_stats
    return json.loads(text)['size'] if text else None


def take_engine_away():
    def refuse():
        raise native.Unavailable('There is no driver; install one.')

    native.use_factory(refuse)
    edit_world()
    background().inputs['Strength'].default_value = 0.5


def failure():
    view = viewport()
    return view._failure or None


def bring_engine_back():
    native.use_factory(None)
    background().inputs['Strength'].default_value = 1.0


def other_shading():
    area('VIEW_3D').spaces[0].shading.type = 'SOLID'


def nothing():
    return True


STEPS = [('start', start, picture), ('world', edit_world, picture), ('plane', add_plane, picture),
         ('turned', turn_view, picture), ('final', final_render, final_result),
         ('without engine', take_engine_away, failure), ('again', bring_engine_back, picture),
         ('solid', other_shading, nothing)]

state = {'step': 0, 'acted': False, 'since': 0.0}


def tick():
    """Do the next step, or see whether the last one has led to something."""
    try:
        name, action, result = STEPS[state['step']]
        if not state['acted']:
            state.update(acted=True, since=time.monotonic())
            action()
            # Blender has to notice the edit before its picture counts.
            return 1.5
        found = result()
        late = time.monotonic() - state['since'] > LIMIT
        if found is None and not late:
            return 0.2
        shown[name] = found
        state.update(step=state['step'] + 1, acted=False)
        if late or state['step'] == len(STEPS):
            finish()
            return None
        return 0.1
    except Exception:  # nothing that happens in a timer ends Blender by itself
        traceback.print_exc()
        finish()
        os._exit(3)


def finish():
    with open(OUT, 'w', encoding='utf-8') as file:
        json.dump(shown, file)
    native.close()
    bpy.ops.wm.quit_blender()


bpy.context.preferences.view.show_splash = False
bpy.app.timers.register(tick, first_interval=1.0)
