# SPDX-License-Identifier: GPL-3.0-or-later
"""Camera and film settings, each rendered by Cycles and by Panoptes: same frame, same light.

Blocks in a sun without shadows fill the view, so that a frame that is off by a part of a pixel, a
filter of another width or another exposure shows in the numbers.
"""

import bpy
import numpy as np
import pytest

from panoptes import compat, native, passes
from test_engine import lamp, render_combined, render_passes, world

# At so many the noise of edges is two per cent, and an image off by a tenth of a pixel stands out.
SAMPLES = 512


def material(name, color, shine):
    found = bpy.data.materials.new(name)
    found.use_nodes = True
    tree = found.node_tree
    tree.nodes.clear()
    surface, output = (tree.nodes.new('ShaderNode' + kind)
                       for kind in ('Emission' if shine else 'BsdfDiffuse', 'OutputMaterial'))
    surface.inputs['Color'].default_value = (*color, 1.0)
    tree.links.new(surface.outputs[0], output.inputs['Surface'])
    return found


@pytest.fixture
def blocks(scene, native_module):
    """Nine blocks at different depths, in a sun that casts no shadow."""
    return build(scene, False)


def build(scene, shine):
    """Make the blocks; those that shine are in no other light."""
    native.use_factory(None)
    if not shine:
        sun = lamp('SUN', 2.0)
        sun.angle = 0.0
        for owner, name, _ in compat.light_shadow_switches(sun):
            setattr(owner, name, False)
    for index in range(9):
        bpy.ops.mesh.primitive_cube_add(size=1.0)
        thing = bpy.context.object
        thing.location = (index % 3 * 2.0 - 2.0, index // 3 * 1.5 - 1.5, -0.7 * index)
        thing.rotation_euler = (0.3 * index, 0.2, 0.1)
        thing.data.materials.append(material(
            'Block', (0.2 + 0.1 * index, 1.0 - 0.1 * index, 0.5), shine))
    world((0.0, 0.0, 0.0))
    scene.camera.data.lens = 60.0
    scene.panoptes.samples = SAMPLES
    scene.panoptes.bounces = 0
    return scene


def in_cycles(scene, render, seed=0):
    """Return what `render` gives for Cycles with the settings that Panoptes has."""
    scene.render.engine = 'CYCLES'
    scene.cycles.samples, scene.cycles.seed = SAMPLES, seed
    scene.cycles.max_bounces = 0
    scene.cycles.use_denoising = scene.cycles.use_adaptive_sampling = False
    scene.cycles.film_exposure = scene.panoptes.exposure
    scene.cycles.filter_width = scene.render.filter_size
    found = render()
    scene.render.engine = 'PANOPTES'
    return found


def distance(ours, theirs):
    """RMSE relative to the reference's mean; linear."""
    assert ours.shape == theirs.shape and theirs.mean() > 0.02
    return np.sqrt(((ours - theirs).astype(np.float64) ** 2).mean()) / theirs.mean()


def shift(ours, theirs):
    """Return by how many pixels (right, down) one picture seems to be moved against the other."""
    down, right = np.gradient(theirs.astype(np.float64))
    slopes = np.stack([right.ravel(), down.ravel()], axis=1)
    return np.linalg.lstsq(slopes, (theirs - ours).astype(np.float64).ravel(), rcond=None)[0]


def change(scene, **settings):
    """Set attributes by path; `camera__`, `dof__` and `render__` begin paths from there."""
    places = {'camera': scene.camera.data, 'dof': scene.camera.data.dof, 'render': scene.render}
    for path, value in settings.items():
        place, name = path.split('__')
        setattr(places[place], name, value)


CASES = {
    'plain': {},
    'percentage': {'render__resolution_percentage': 55},
    'shift': {'camera__shift_x': 0.2, 'camera__shift_y': -0.15},
    'clip': {'camera__clip_start': 10.5, 'camera__clip_end': 13.4},
    'sensor fit vertical': {'camera__sensor_fit': 'VERTICAL', 'camera__sensor_height': 30.0},
    'upright': {'render__resolution_x': 20, 'render__resolution_y': 32},
    'pixel aspect': {'render__pixel_aspect_x': 1.0, 'render__pixel_aspect_y': 1.7},
    'wide pixels': {'render__pixel_aspect_x': 2.0, 'render__pixel_aspect_y': 1.0,
                    'camera__shift_y': 0.1},
    'orthographic': {'camera__type': 'ORTHO', 'camera__ortho_scale': 7.0, 'camera__shift_x': 0.1},
    'narrow filter': {'render__filter_size': 0.5},
    'wide filter': {'render__filter_size': 3.0},
    'transparent': {'render__film_transparent': True},
    'border': {'render__use_border': True, 'render__border_min_x': 0.21, 'render__border_max_x': 0.77,
               'render__border_min_y': 0.3, 'render__border_max_y': 0.95},
    'cropped border': {'render__use_border': True, 'render__use_crop_to_border': True,
                       'render__border_min_x': 0.21, 'render__border_max_x': 0.77,
                       'render__border_min_y': 0.3, 'render__border_max_y': 0.95},
}


@pytest.mark.parametrize('settings', CASES.values(), ids=CASES.keys())
def test_picture_is_that_of_cycles(blocks, tmp_path, settings):
    change(blocks, **settings)

    def render():
        return render_combined(blocks, tmp_path)

    ours, theirs, again = render(), in_cycles(blocks, render), in_cycles(blocks, render, seed=1)
    noise = distance(again[..., :3], theirs[..., :3])
    assert distance(ours[..., :3], theirs[..., :3]) < 1.5 * noise
    assert np.abs(shift(ours[..., 1], theirs[..., 1])).max() < 0.02
    assert ours[..., :3].mean() == pytest.approx(theirs[..., :3].mean(), rel=0.005)
    assert np.allclose(ours[..., 3], theirs[..., 3], atol=0.03)


# One depth is in focus; blocks at others are blurred over several pixels, well beyond the noise of either engine.
LENSES = {
    'disk': {'dof__focus_distance': 12.1, 'dof__aperture_fstop': 0.02},
    'blades': {'dof__focus_distance': 12.1, 'dof__aperture_fstop': 0.012, 'dof__aperture_blades': 3,
               'dof__aperture_rotation': 0.4},
    'anamorphic': {'dof__focus_distance': 8.0, 'dof__aperture_fstop': 0.03, 'dof__aperture_ratio': 2.5},
    'orthographic': {'dof__focus_distance': 12.1, 'dof__aperture_fstop': 0.5, **CASES['orthographic']},
}


@pytest.mark.parametrize('settings', LENSES.values(), ids=LENSES.keys())
def test_depth_of_field_is_that_of_cycles(blocks, tmp_path, settings):
    blocks.panoptes.method, blocks.panoptes.bounces = 'primitive', 0

    def render():
        return render_combined(blocks, tmp_path)

    sharp = render()
    blocks.camera.data.dof.use_dof = True
    change(blocks, **settings)
    ours, theirs, again = render(), in_cycles(blocks, render), in_cycles(blocks, render, seed=1)
    noise = distance(again[..., :3], theirs[..., :3])
    assert distance(sharp[..., :3], theirs[..., :3]) > 3.0 * noise
    assert distance(ours[..., :3], theirs[..., :3]) < 1.5 * noise
    assert ours[..., :3].mean() == pytest.approx(theirs[..., :3].mean(), rel=0.01)


@pytest.mark.parametrize('name', ['plain', 'clip', 'orthographic', 'pixel aspect', 'border'])
def test_depth_is_that_of_cycles(blocks, tmp_path, name):
    change(blocks, **CASES[name])
    # Depth is not filtered: without a filter the samples of a pixel all have the same.
    blocks.render.filter_size = 0.01
    blocks.panoptes.samples = 1
    blocks.view_layers[0].use_pass_z = True

    def render():
        return render_passes(blocks, tmp_path)['Depth'][..., 0]

    ours, theirs = render(), in_cycles(blocks, render)
    assert 0.1 < (theirs < 1e9).mean() < 0.9
    close = np.isclose(ours, theirs, rtol=1e-3)
    # A ray may graze a corner in one and miss it in the other.
    assert (~close).sum() <= 3


@pytest.mark.parametrize('shine', [False, True])
def test_exposure_scales_light_as_in_cycles(scene, native_module, tmp_path, shine):
    build(scene, shine)
    # Glowing things take long, and the mean of a picture needs few samples.
    scene.panoptes.samples, scene.panoptes.realtime.shadow_resolution = 32, 64
    passes.enable_all(scene.view_layers[0], 'realtime')

    def render():
        return render_passes(scene, tmp_path)

    plain = render()
    scene.panoptes.exposure = 3.0
    ours, theirs = render(), in_cycles(scene, render)
    assert ours['Combined'][..., :3].mean() == pytest.approx(theirs['Combined'][..., :3].mean(), rel=0.01)
    light = 'Emit' if shine else 'DiffDir'
    assert np.allclose(ours[light], 3.0 * plain[light], rtol=1e-5) and plain[light].max() > 0.1
    assert np.allclose(ours['Combined'][..., :3], 3.0 * plain['Combined'][..., :3], rtol=1e-5)
    for name in ('Depth', 'Normal', 'DiffCol'):
        assert np.array_equal(ours[name], plain[name])
    assert np.array_equal(ours['Combined'][..., 3], plain['Combined'][..., 3])
