# SPDX-License-Identifier: GPL-3.0-or-later
"""Generated coordinates of modified meshes are those that Cycles sees."""

import bpy
import numpy as np
import pytest

from building import add_object, quad

SIZE = 24


def glowing():
    """A material that shines with its generated coordinates."""
    material = bpy.data.materials.new('Generated')
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    output, shine, where = (tree.nodes.new(name) for name in (
        'ShaderNodeOutputMaterial', 'ShaderNodeEmission', 'ShaderNodeTexCoord'))
    tree.links.new(where.outputs['Generated'], shine.inputs['Color'])
    tree.links.new(shine.outputs[0], output.inputs['Surface'])
    return material


def arrayed(thing):
    thing.modifiers.new('Array', 'ARRAY').count = 2


def bent(thing):
    thing.modifiers.new('Subdivision', 'SUBSURF').subdivision_type = 'SIMPLE'
    thing.modifiers['Subdivision'].levels = thing.modifiers['Subdivision'].render_levels = 4
    bend = thing.modifiers.new('Taper', 'SIMPLE_DEFORM')
    bend.deform_method, bend.factor, bend.deform_axis = 'TAPER', -0.8, 'X'


def keyed(thing):
    thing.shape_key_add(name='Basis')
    key = thing.shape_key_add(name='Key')
    key.data[2].co = (1.6, 1.9, 0)
    key.value = 1


def moved_texture_space(thing):
    thing.data.use_auto_texspace = False
    thing.data.texspace_location, thing.data.texspace_size = (0.25, 0.5, 0), (0.5, 2, 1)


def nothing(thing):
    del thing


def render(scene, engine, path):
    """Render and return the linear picture, float32[SIZE, SIZE, 3]."""
    scene.render.engine = engine
    scene.render.filepath = str(path / f'{engine}.exr')
    bpy.ops.render.render(write_still=True)
    pixels = np.empty((SIZE, SIZE, 4), np.float32)
    image = bpy.data.images.load(scene.render.filepath)
    image.pixels.foreach_get(pixels.reshape(-1))
    bpy.data.images.remove(image)
    return pixels[..., :3]


@pytest.mark.parametrize('modify', [nothing, arrayed, bent, keyed, moved_texture_space],
                         ids=lambda modify: modify.__name__)
def test_generated_as_cycles(scene, native_module, tmp_path, modify):
    mesh = quad()
    mesh.materials.append(glowing())
    modify(add_object(mesh))
    scene.camera.data.type, scene.camera.data.ortho_scale = 'ORTHO', 2.0
    scene.camera.location = (1.0, 1.0, 10.0)
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.render.image_settings.file_format = 'OPEN_EXR'
    scene.render.image_settings.color_depth = '32'
    scene.panoptes.samples = 64
    scene.cycles.samples, scene.cycles.device = 64, 'CPU'
    scene.cycles.use_denoising = scene.cycles.use_adaptive_sampling = False
    ours, theirs = (render(scene, engine, tmp_path) for engine in ('PANOPTES', 'CYCLES'))
    # The plane's third coordinate is one half: less is a silhouette, where samples differ. So they do
    # where the coordinates start anew within a pixel or beside it.
    inside = np.abs(theirs[..., 2] - 0.5) < 1e-3
    for axis in (0, 1):
        for shift in (-1, 1):
            inside &= np.abs(np.roll(theirs, shift, axis) - theirs).max(axis=2) < 0.25
    assert inside.sum() > SIZE
    # A pixel covers up to a tenth of the range, and 64 samples find its mean to a tenth of that.
    assert np.abs(ours - theirs)[inside].max() < 0.03
    assert np.abs(ours - theirs)[inside].mean() < 0.005
