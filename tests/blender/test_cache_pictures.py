# SPDX-License-Identifier: GPL-3.0-or-later
"""What settings of indirect light change in the picture, from Blender's properties to the pixels."""

import bpy
import numpy as np
import pytest

from building import add_object
from panoptes import native
from test_engine import ground, lamp, render_combined, render_passes

PICTURES = ('geometry', 'occupancy', 'lobes', 'light', 'clipped')
ENCODINGS = ('Y3CO1CG1', 'Y3CO2CG2', 'Y3CO3CG3', 'RGB3', 'Y2CO2CG2', 'RGB2')
# Columns of pixels, left and right on the floor, away from its middle and from the walls.
LEFT, RIGHT = slice(6, 13), slice(19, 26)


@pytest.fixture(autouse=True)
def _needs_native(native_module):
    native.use_factory(None)


@pytest.fixture
def alley(scene):
    """A white floor between a red wall on the left and a green one on the right, lit by a lamp above."""
    paint(ground(7.0), 'White', (0.8, 0.8, 0.8))
    for x, name, color in ((-3.0, 'Red', (0.8, 0.05, 0.05)), (3.0, 'Green', (0.05, 0.8, 0.05))):
        bpy.ops.mesh.primitive_cube_add(size=1.0, location=(x, 0.0, 1.0), scale=(0.5, 7.0, 2.0))
        paint(bpy.context.object, name, color)
    lamp('POINT', 500.0, (0.0, 0.0, 3.0))
    scene.view_layers[0].use_pass_diffuse_indirect = True
    return scene


def paint(thing, name, color):
    """Give an object a diffuse material and the material's name."""
    thing.name = name
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    diffuse = tree.nodes.new('ShaderNodeBsdfDiffuse')
    diffuse.inputs['Color'].default_value = (*color, 1.0)
    output = next(n for n in tree.nodes if n.type == 'OUTPUT_MATERIAL')
    tree.links.new(diffuse.outputs[0], output.inputs['Surface'])
    thing.data.materials.append(material)


@pytest.fixture
def bounced(alley, tmp_path):
    """What renders the alley and returns DiffInd, float32[24, 32, 3]."""
    return lambda: render_passes(alley, tmp_path)['DiffInd']


def test_walls_tint_the_floor_beside_them(bounced):
    found = bounced()
    red, green, _ = found[:, LEFT].mean(axis=(0, 1))
    assert red > 1.2 * green
    red, green, _ = found[:, RIGHT].mean(axis=(0, 1))
    assert green > 1.2 * red


def test_more_bounces_bring_more_light(alley, bounced):
    means = []
    for bounces in (0, 1, 2, 4):
        alley.panoptes.radiance_cache.bounces = bounces
        means.append(bounced().mean())
    none, one, two, four = means
    # Each bounce adds less than the one before.
    assert none == 0.0 < one < two < four and four - two < two - one < one


def test_switched_off(alley, bounced):
    alley.panoptes.radiance_cache.enabled = False
    assert not bounced().any()


def test_encodings_agree_on_brightness_and_differ_in_hue(alley, bounced):
    found = {}
    for encoding in ENCODINGS:
        alley.panoptes.radiance_cache.encoding = encoding
        found[encoding] = bounced()
    whole = found['RGB3']
    # Only where harmonics ring below 0 does it matter in which space they do.
    assert np.abs(found['Y3CO3CG3'] - whole).mean() < 0.002 * whole.mean()
    for encoding, light in found.items():
        assert light.mean() == pytest.approx(whole.mean(), rel=0.15)
        # Each is a program of its own.
        assert all(not np.array_equal(light, other) for name, other in found.items() if name != encoding)
    errors = [np.abs(found[encoding] - whole).mean() for encoding in ('Y3CO1CG1', 'Y3CO2CG2', 'Y3CO3CG3')]
    assert errors == sorted(errors, reverse=True)


def test_scales_of_all_light(alley, bounced):
    before = bounced()
    ours = alley.panoptes.radiance_cache
    ours.luminance = 0.5
    assert np.allclose(bounced(), 0.5 * before, rtol=1e-3, atol=1e-5)
    ours.luminance, ours.chrominance = 1.0, 0.0
    grey = bounced()
    assert np.allclose(grey, grey[:, :, :1], rtol=1e-3, atol=1e-5) and grey.mean() > 0.0


def test_an_objects_scale_changes_what_it_receives(bounced):
    before = bounced()
    floor = bpy.data.objects['White'].panoptes
    floor.indirect_luminance = 2.0
    twice = bounced()
    for side in (LEFT, RIGHT):
        assert np.allclose(twice[:, side], 2.0 * before[:, side], rtol=1e-3, atol=1e-5)
    floor.indirect_luminance, floor.indirect_chrominance = 1.0, 0.0
    grey = bounced()[:, LEFT]
    assert np.allclose(grey, grey[:, :, :1], rtol=1e-3, atol=1e-5)


def test_a_region_changes_what_lies_in_it(alley, bounced):
    before = bounced()
    boxes = bpy.data.collections.new('Boxes')
    box = add_object(None, 'Left', empty_display_type='CUBE', location=(-4.0, 0.0, 0.0), scale=(4.0, 9.0, 9.0))
    boxes.objects.link(box)
    alley.panoptes.radiance_cache.region_collection = boxes
    box.panoptes.indirect_luminance = 0.0
    after = bounced()
    assert not after[:, LEFT].any()
    assert np.allclose(after[:, RIGHT], before[:, RIGHT], rtol=1e-3, atol=1e-5)


def test_each_debug_picture_shows_something_else(alley, tmp_path):
    seen = [render_combined(alley, tmp_path)]
    for name in PICTURES:
        alley.panoptes.debug_picture = f'cache_{name}'
        picture = render_combined(alley, tmp_path)
        assert np.isfinite(picture).all()
        assert all(not np.array_equal(picture, other) for other in seen)
        if name != 'clipped':
            assert picture[:, LEFT, :3].any() and picture[:, RIGHT, :3].any()
        seen.append(picture)
    geometry, occupancy, _, light, clipped = seen[1:]
    # Voxels have the colours of surfaces, cells are green where they are occupied and red beside them.
    red, green, _ = geometry[12, 3, :3]
    assert red > 4.0 * green
    assert not occupancy[:, LEFT, 2].max() > occupancy[:, LEFT, :2].max()
    assert light[:, LEFT, 0].mean() > light[:, LEFT, 1].mean()
    assert (clipped[..., :3] >= 0.0).all() and (clipped[..., :3] <= 1.0).all()
    assert clipped[:, 6:26, 0].mean() < 0.01
