# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender with a window: what a 3D View shows by its Render Pass, and its statistics."""

import os
import sys

import bpy
import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from window_steps import area, background, nothing, pictures, run, viewports  # noqa: E402

import panoptes  # noqa: E402
from panoptes import compat, overlay, session  # noqa: E402

drawn = []


def shading():
    return area('VIEW_3D').spaces[0].shading


def start():
    panoptes.register()
    scene = bpy.context.scene
    scene.render.engine = 'PANOPTES'
    scene.panoptes.method = 'realtime'
    scene.panoptes.viewport_samples = 4
    for thing in list(scene.objects):
        if thing.type != 'CAMERA':
            bpy.data.objects.remove(thing)
    scene.world.use_nodes = True
    background().inputs['Color'].default_value = (0.0, 0.5, 0.0, 1.0)
    bpy.ops.mesh.primitive_plane_add(size=1000)
    material = bpy.data.materials.new('Matt')
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    diffuse, output = tree.nodes.new('ShaderNodeBsdfDiffuse'), tree.nodes.new('ShaderNodeOutputMaterial')
    diffuse.inputs['Color'].default_value = (0.7, 0.4, 0.1, 1.0)
    tree.links.new(diffuse.outputs['BSDF'], output.inputs['Surface'])
    bpy.context.object.data.materials.append(material)
    region = area('VIEW_3D').spaces[0].region_3d
    region.view_distance, region.view_rotation = 3.0, (1.0, 0.0, 0.0, 0.0)
    draw_text = compat.draw_text

    def note(lines, *where):
        drawn.append((list(lines), *where))
        draw_text(lines, *where)

    compat.draw_text = note
    shading().type = 'RENDERED'


def picture():
    """Return the mean colour, how much it varies and what is said; None while it is not done."""
    found = pictures()
    if not found:
        return None
    # Sums of so many pixels are inexact otherwise.
    colors = found[0][..., :3].astype(np.float64)
    view = viewports()[0]
    skipped = [e['name'] for e in view._picture.stage.stats['effects'] if not e['runs']]
    return {'mean': colors.mean(axis=(0, 1)).tolist(), 'spread': float(np.ptp(colors, axis=(0, 1)).max()),
            'status': view._status(), 'skipped': skipped}


def show(identifier):
    def act():
        shading().panoptes.render_pass = identifier
        area('VIEW_3D').tag_redraw()

    return act


def refine_by_paths():
    bpy.context.scene.panoptes.method = 'primitive'
    area('VIEW_3D').tag_redraw()


def count_draws():
    return len(drawn)


def show_statistics():
    drawn.clear()
    shading().panoptes.show_statistics = True
    area('VIEW_3D').tag_redraw()


def text():
    """Return what was drawn last, with where, once it tells of the finished picture."""
    if not picture() or not drawn or 'samples' not in drawn[-1][0][0]:
        return None
    lines, left, bottom, size = drawn[-1][:4]
    return {'lines': lines, 'left': left, 'bottom': bottom, 'size': size}


def bigger_interface():
    bpy.context.preferences.view.ui_scale = 1.5
    drawn.clear()
    area('VIEW_3D').tag_redraw()


def hide_overlays():
    bpy.context.preferences.view.ui_scale = 1.0
    area('VIEW_3D').spaces[0].overlay.show_overlays = False
    bpy.app.timers.register(drawn.clear, first_interval=0.3)


def break_the_text():
    area('VIEW_3D').spaces[0].overlay.show_overlays = True

    def refuse(*arguments):
        raise ValueError('broken on purpose')

    compat.draw_text = refuse
    for _ in range(2):
        bpy.ops.wm.redraw_timer(type='DRAW_WIN_SWAP', iterations=1)


def unregister():
    area('VIEW_3D').spaces[0].shading.type = 'SOLID'
    bpy.context.scene.render.engine = 'BLENDER_WORKBENCH'
    panoptes.unregister()
    bpy.ops.wm.redraw_timer(type='DRAW_WIN_SWAP', iterations=2)


def leftovers():
    return [overlay._handle is None, hasattr(bpy.types.View3DShading, 'panoptes'), session.last_error]


run([('combined', start, picture), ('color', show('DIFFUSE_COLOR'), picture),
     ('no text', nothing, count_draws), ('text', show_statistics, text),
     ('normal', show('NORMAL'), picture), ('direct', show('DIFFUSE_DIRECT'), picture),
     ('occlusion', show('AO'), picture), ('paths', refine_by_paths, picture),
     ('text of paths', nothing, text), ('color beside paths', show('DIFFUSE_COLOR'), picture),
     ('big text', bigger_interface, text), ('hidden', hide_overlays, lambda: None if drawn else True),
     ('text while hidden', lambda: area('VIEW_3D').tag_redraw(), count_draws),
     ('broken', break_the_text, nothing), ('unregistered', unregister, leftovers)])
