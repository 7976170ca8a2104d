# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender with a window: several 3D Views, their borders and local views; previews."""

import json
import os
import sys

import bpy
import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from window_steps import area, areas, background, mean, pictures, run, viewports  # noqa: E402

import panoptes  # noqa: E402
from panoptes import refinement  # noqa: E402

DOWNWARDS, LEVEL = (1.0, 0.0, 0.0, 0.0), (0.7071, 0.7071, 0.0, 0.0)
_starts = []


def count_starts():
    """Note every job of a 3D View."""
    start = refinement.Refinement.start

    def counted(self, engine):
        _starts.append(self)
        start(self, engine)

    refinement.Refinement.start = counted


def shining(name, color):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    shine, output = (tree.nodes.new('ShaderNode' + kind) for kind in ('Emission', 'OutputMaterial'))
    shine.inputs['Color'].default_value = (*color, 1.0)
    tree.links.new(shine.outputs[0], output.inputs['Surface'])
    return material


def missing(name):
    """Return an image whose file does not exist."""
    image = bpy.data.images.new(name, 1, 1)
    image.source, image.filepath = 'FILE', '//' + name
    return image


def start():
    """A red floor under a green sky, and a small blue cube on the floor."""
    panoptes.register()
    count_starts()
    scene = bpy.context.scene
    scene.render.engine = 'PANOPTES'
    scene.panoptes.method = 'realtime'
    scene.panoptes.viewport_samples = 8
    # Things that shine cast light, which is not what is looked at here.
    scene.panoptes.realtime.shadow_resolution = 64
    scene.panoptes.realtime.soft_shadows = False
    scene.render.resolution_x, scene.render.resolution_y = 64, 48
    for thing in list(scene.objects):
        if thing.type != 'CAMERA':
            bpy.data.objects.remove(thing)
    bpy.ops.mesh.primitive_cube_add(size=1.0, location=(0, 0, 0.5))
    bpy.context.object.data.materials.append(shining('Blue', (0.0, 0.0, 1.0)))
    bpy.ops.mesh.primitive_plane_add(size=1000.0)
    bpy.context.object.name = 'Floor'
    bpy.context.object.data.materials.append(shining('Red', (1.0, 0.0, 0.0)))
    scene.camera.location, scene.camera.rotation_euler = (0.0, 0.0, 8.0), (0.0, 0.0, 0.0)
    scene.world.use_nodes = True
    background().inputs['Color'].default_value = (0.0, 1.0, 0.0, 1.0)
    for space in (a.spaces[0] for a in areas('VIEW_3D')):
        space.overlay.show_overlays = False
        space.shading.type = 'RENDERED'


def look(index, rotation, distance=6.0):
    region = areas('VIEW_3D')[index].spaces[0].region_3d
    region.view_perspective = 'PERSP'
    region.view_location, region.view_distance = (0.0, 0.0, 0.5), distance
    region.view_rotation = rotation


def split():
    """Two 3D Views side by side, one from above and one from below the floor's edge."""
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window, area=area('VIEW_3D')):
        bpy.ops.screen.area_split(direction='VERTICAL', factor=0.5)
    for index, rotation in enumerate((DOWNWARDS, LEVEL)):
        look(index, rotation)
        areas('VIEW_3D')[index].spaces[0].shading.type = 'RENDERED'


def means():
    """Return the mean colours of all views' pictures, sorted so that their order does not matter."""
    found = pictures()
    return sorted((mean(pixels) for pixels in found), reverse=True) if found else None


def local_view():
    """Only the floor in the first view."""
    floor = bpy.data.objects['Floor']
    for thing in bpy.context.scene.objects:
        thing.select_set(thing is floor)
    bpy.context.view_layer.objects.active = floor
    window, first = bpy.context.window_manager.windows[0], areas('VIEW_3D')[0]
    region = next(r for r in first.regions if r.type == 'WINDOW')
    with bpy.context.temp_override(window=window, area=first, region=region):
        bpy.ops.view3d.localview(frame_selected=False)


def blue():
    """Return for each view whether any pixel shows the blue cube, and how many jobs there were."""
    found = pictures()
    if not found:
        return None
    return sorted(bool((pixels[..., 2] > 0.5).any()) for pixels in found)


def change_view_transform():
    _starts.clear()
    scene = bpy.context.scene
    scene.view_settings.exposure = 1.5
    scene.view_settings.view_transform = 'Standard'
    scene.view_settings.look = 'None'


def jobs_started():
    return len(_starts) if pictures() else None


def select_something():
    _starts.clear()
    bpy.data.objects['Floor'].select_set(False)
    bpy.context.view_layer.objects.active = bpy.context.scene.camera


def camera_border():
    """The first view is the camera's, of which the left half is rendered."""
    scene = bpy.context.scene
    scene.render.use_border = True
    scene.render.border_min_x, scene.render.border_max_x = 0.0, 0.5
    scene.render.border_min_y, scene.render.border_max_y = 0.0, 1.0
    areas('VIEW_3D')[0].spaces[0].region_3d.view_perspective = 'CAMERA'


def rectangles():
    """Return the places of the pictures and the sizes of the regions."""
    if not pictures():
        return None
    regions = [next(r for r in a.regions if r.type == 'WINDOW') for a in areas('VIEW_3D')]
    return {'pictures': sorted([*map(int, view._rectangle), *view._pixels.shape[1::-1]]
                               for view in viewports()),
            'regions': [(r.width, r.height) for r in regions]}


def view_border():
    """The second view renders its middle only."""
    space = areas('VIEW_3D')[1].spaces[0]
    space.use_render_border = True
    space.render_border_min_x, space.render_border_max_x = 0.25, 0.75
    space.render_border_min_y, space.render_border_max_y = 0.25, 0.75


def no_border():
    bpy.context.scene.render.use_border = False
    areas('VIEW_3D')[1].spaces[0].use_render_border = False
    areas('VIEW_3D')[0].spaces[0].region_3d.view_perspective = 'PERSP'


def resize():
    """Give the row of the time line to the views."""
    window = bpy.context.window_manager.windows[0]
    for other in areas('DOPESHEET_EDITOR'):
        with bpy.context.temp_override(window=window, area=other):
            bpy.ops.screen.area_close()


def ask_for_previews():
    """Icons of a material, the world, a lamp and a texture."""
    material = bpy.data.materials.new('Odd')
    material.use_nodes = True
    tree = material.node_tree
    surface = next(n for n in tree.nodes if n.type == 'BSDF_PRINCIPLED')
    surface.inputs['Base Color'].default_value = (0.0, 0.9, 0.05, 1.0)
    picture = tree.nodes.new('ShaderNodeTexImage')
    picture.image = missing('nowhere.png')
    tree.links.new(picture.outputs['Alpha'], surface.inputs['Roughness'])
    lamp = bpy.data.lights.new('Lamp', 'AREA')
    texture = bpy.data.textures.new('Clouds', 'CLOUDS')
    _starts.clear()
    for data in (material, bpy.context.scene.world, lamp, texture):
        data.use_fake_user = True
        data.asset_generate_preview()


def previews():
    """Return the mean colour of each preview, or None while one is missing."""
    found = {}
    things = (bpy.data.materials['Odd'], bpy.context.scene.world, bpy.data.lights['Lamp'])
    for data in things:
        width, height = data.preview.image_size if data.preview else (0, 0)
        if not width:
            return None
        pixels = np.array(data.preview.image_pixels_float[:], np.float32).reshape(height, width, 4)
        if not pixels[..., 3].any():
            return None
        found[data.bl_rna.identifier] = [*map(float, pixels.mean(axis=(0, 1)))]
    return found if pictures() else None


def state_after_previews():
    """Return what previews must not touch: the views' jobs and the last final render."""
    if not pictures():
        return None
    return {'jobs': len(_starts), 'size': json.loads(bpy.context.scene.panoptes.last_stats)['size']}


def final_render():
    bpy.ops.render.render('INVOKE_DEFAULT')


def final_result():
    text = bpy.context.scene.panoptes.last_stats
    return json.loads(text)['size'] if text and pictures() else None


def material_preview():
    for space in (a.spaces[0] for a in areas('VIEW_3D')):
        space.shading.type = 'MATERIAL'


def many_icons():
    """Material Preview goes on while icons are drawn and the view changes its shading."""
    for index in range(4):
        shining(f'Icon {index}', (0.25 * index, 0.5, 0.5)).asset_generate_preview()
    for space in (a.spaces[0] for a in areas('VIEW_3D')):
        space.shading.type = 'RENDERED'


def missing_image():
    """A world whose image is missing: the artist is told."""
    tree = bpy.context.scene.world.node_tree
    picture = tree.nodes.new('ShaderNodeTexEnvironment')
    picture.image = missing('nowhere.exr')
    tree.links.new(picture.outputs['Color'], background().inputs['Color'])


def statuses():
    if not pictures():
        return None
    return sorted({view._status() for view in viewports()})


run([
    ('start', start, means),
    ('split', split, means),
    ('transform', change_view_transform, jobs_started),
    ('selected', select_something, jobs_started),
    ('local', local_view, blue),
    ('camera border', camera_border, rectangles),
    ('view border', view_border, rectangles),
    ('no border', no_border, rectangles),
    ('resized', resize, rectangles),
    ('resized means', lambda: None, means),
    ('final', final_render, final_result),
    ('previews', ask_for_previews, previews),
    ('after previews', lambda: None, state_after_previews),
    ('material preview', material_preview, lambda: True),
    ('icons', many_icons, means),
    ('warned', missing_image, statuses),
])
