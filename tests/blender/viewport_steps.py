# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender with a window: walks through edits and writes what the 3D View showed."""

import json
import os
import sys

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from window_steps import area, background, mean, nothing, pictures, run, viewports  # noqa: E402

import panoptes  # noqa: E402
from panoptes import native, session  # noqa: E402


def picture():
    """Return (mean colour, width, height) of the picture, or None while it is not done."""
    found = pictures()
    return mean(found[0]) if found else None


def start():
    panoptes.register()
    scene = bpy.context.scene
    scene.render.engine = 'PANOPTES'
    scene.panoptes.method = 'realtime'
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


def show_debug_picture(kind):
    bpy.context.scene.panoptes.debug_picture = kind
    # Blender does this itself when the artist chooses in the panel, but not for scripts.
    area('VIEW_3D').tag_redraw()


def trace_paths(method):
    bpy.context.scene.panoptes.method = method
    area('VIEW_3D').tag_redraw()


def picture_of_paths():
    found = picture()
    return None if found is None else [*found, viewports()[0]._status()]


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
    return viewports()[0]._failure or None


def bring_engine_back():
    native.use_factory(None)
    background().inputs['Strength'].default_value = 1.0


def other_shading():
    area('VIEW_3D').spaces[0].shading.type = 'SOLID'


run([('start', start, picture), ('world', edit_world, picture), ('plane', add_plane, picture),
     ('turned', turn_view, picture), ('debug', lambda: show_debug_picture('tiles'), picture),
     ('bent normals', lambda: show_debug_picture('occlusion_bent_normals'), picture),
     ('no debug', lambda: show_debug_picture('none'), picture),
     ('paths', lambda: trace_paths('primitive'), picture_of_paths),
     ('no paths', lambda: trace_paths('auto'), picture),
     ('final', final_render, final_result),
     ('without engine', take_engine_away, failure), ('again', bring_engine_back, picture),
     ('solid', other_shading, nothing)])
