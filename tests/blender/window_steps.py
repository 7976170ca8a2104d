# SPDX-License-Identifier: GPL-3.0-or-later
"""Walks a Blender with a window through steps and writes what each has led to.

blender --factory-startup -P SCRIPT.py -- OUT.json
"""

import json
import os
import subprocess
import sys
import time
import traceback

import bpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(
    os.path.abspath(__file__)))), 'addon'))

from panoptes import native, session  # noqa: E402

LIMIT = 60.0


def areas(kind):
    """Return the window's areas of a type."""
    screen = bpy.context.window_manager.windows[0].screen
    return [a for a in screen.areas if a.type == kind]


def area(kind):
    """Return the first of them."""
    return areas(kind)[0]


def background():
    """Return the node of the world's colour."""
    return next(n for n in bpy.context.scene.world.node_tree.nodes if n.type == 'BACKGROUND')


def viewports():
    """Return what is behind the 3D Views that are rendered."""
    return [view for view in list(session.viewports) if view._picture is not None]


def pictures():
    """Return the pixels of all 3D Views, left view first; None while one of them is not done."""
    views = viewports()
    if not views or any(view.is_rendering() or view._pixels is None for view in views):
        return None
    return [view._pixels for view in views]


def mean(pixels):
    """Return the mean colour, then width and height."""
    height, width = pixels.shape[:2]
    return [*map(float, pixels[..., :3].mean(axis=(0, 1))), width, height]


def nothing():
    """For steps that are done at once."""
    return True


def screenshot(name):
    """Store the screen beside the results, where a test's reader can look at it."""
    folder = os.environ.get('PANOPTES_SCREENSHOTS')
    if folder:
        subprocess.run(['import', '-window', 'root', os.path.join(folder, name + '.png')], check=False)


def run(steps, notice=0.6, poll=0.2, close=True):
    """Do each (name, action, result): act, then wait until `result` is not None, and write it.

    `notice` is how long Blender is left, in seconds, until the first question for a result: at least one round of its
    main loop. `poll` is the time between two questions. Without `close` Blender ends while the engine is at work.
    """
    out = sys.argv[sys.argv.index('--') + 1]
    shown = {}
    state = {'step': 0, 'acted': False, 'since': 0.0}

    def finish():
        with open(out, 'w', encoding='utf-8') as file:
            json.dump(shown, file)
        if close:
            native.close()
        bpy.ops.wm.quit_blender()

    def tick():
        try:
            name, action, result = steps[state['step']]
            if not state['acted']:
                state.update(acted=True, since=time.monotonic())
                action()
                # Blender has to notice the edit before its picture counts.
                return notice
            found = result()
            # A redraw may have taken long; only a step that leads to nothing is too late.
            late = found is None and time.monotonic() - state['since'] > LIMIT
            if found is None and not late:
                return poll
            shown[name] = found
            screenshot(name)
            state.update(step=state['step'] + 1, acted=False)
            if late or state['step'] == len(steps):
                finish()
                return None
            return min(poll, 0.1)
        except Exception:  # nothing that happens in a timer ends Blender by itself
            traceback.print_exc()
            finish()
            os._exit(3)

    bpy.context.preferences.view.show_splash = False
    # Files may be opened on the way.
    bpy.app.timers.register(tick, first_interval=1.0, persistent=True)
