# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of rays at work in place of the scene: what is asked for, what is shown, what is left."""

import bpy
import numpy as np
import pytest

from panoptes import native, session
from test_engine import lamp, render_combined, render_passes, world

KINDS = ('steps', 'tests', 'lists', 'tiles')


def things():
    """Make two cubes under a sun, before a blue world."""
    for place in (-1.5, 1.5):
        bpy.ops.mesh.primitive_cube_add(size=2.0)
        bpy.context.object.location = (place, 0.5, 0.0)
        bpy.context.object.rotation_euler = (0.3, 0.5, place)
    lamp('SUN', 2.0)
    world((0.0, 0.0, 0.5))


def test_request(scene, recorder):
    scene.panoptes.samples, scene.panoptes.first_sample = 7, 2
    bpy.ops.render.render()
    scene.panoptes.debug_picture = 'tiles'
    bpy.ops.render.render()
    plain, debug = (arguments[0] for arguments in recorder.arguments('render'))
    assert not {'debug_picture', 'structure'} & plain['settings'].keys() and plain['samples'] == (2, 9)
    assert debug['settings']['debug_picture'] == 'tiles' and debug['samples'] == (0, 1)
    assert (debug['settings']['structure'], debug['settings']['tiles'], debug['settings']['buckets']) == ('auto', 0, 0)


class TestForReal:
    """Pictures from the native module."""

    @pytest.fixture(autouse=True)
    def _needs_native(self, native_module):
        native.use_factory(None)

    def test_each_shows_something_else(self, scene, tmp_path):
        things()
        pictures = [render_combined(scene, tmp_path)]
        for kind in KINDS:
            scene.panoptes.debug_picture = kind
            picture = render_combined(scene, tmp_path)
            assert (picture[..., 3] == 1.0).all()
            # The cubes are in the middle of each half, the world in the corners.
            assert picture[12, 8, :3].any() and picture[12, 24, :3].any()
            assert all(not np.allclose(picture, other) for other in pictures)
            pictures.append(picture)

    def test_each_structure(self, scene, tmp_path):
        things()
        scene.panoptes.debug_picture = 'steps'
        pictures = []
        for structure in ('orthographic', 'cube', 'bvh'):
            scene.panoptes.primitive.structure = structure
            picture = render_combined(scene, tmp_path)
            assert picture[12, 8, :3].any() and all(not np.allclose(picture, other) for other in pictures)
            pictures.append(picture)

    def test_nothing_is_left_of_it(self, scene, tmp_path):
        things()
        before = render_combined(scene, tmp_path)
        bytes_before = session.last_stats['memory_bytes']
        scene.panoptes.debug_picture = 'steps'
        render_combined(scene, tmp_path)
        running = {effect['name'] for effect in session.last_stats['effects'] if effect['runs']}
        assert running == {'triangles', 'structure', 'rays', 'pass_combined'}
        assert session.last_stats['rays'] == 32 * 24
        assert session.last_stats['memory_bytes'] > bytes_before
        scene.panoptes.debug_picture = 'none'
        assert np.array_equal(render_combined(scene, tmp_path), before)
        assert session.last_stats['memory_bytes'] == bytes_before

    def test_other_passes_stay_black(self, scene, tmp_path):
        things()
        scene.view_layers[0].use_pass_normal = True
        scene.panoptes.debug_picture = 'lists'
        found = render_passes(scene, tmp_path)
        assert found['Combined'][..., :3].any() and not found['Normal'].any()
