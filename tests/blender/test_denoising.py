# SPDX-License-Identifier: GPL-3.0-or-later
"""The denoiser's options, what requests say of it, and the pass that keeps the noise."""

import json

import bpy
import numpy as np
import pytest
from panoptes import denoising, passes, requests, session
from test_engine import render_passes


@pytest.fixture
def primitive(scene):
    """The scene, rendered by paths."""
    scene.panoptes.method = 'primitive'
    return scene


def final(part=False):
    said = []
    request = requests.final(bpy.context.evaluated_depsgraph_get(), ('Combined',), said.append, part=part)
    return request['settings'], said


class TestRequests:
    """`denoise` of a request's settings."""

    def test_final_renders_are_left_alone(self, primitive):
        assert 'denoise' not in final()[0]

    @pytest.mark.parametrize('name', ['AUTO', 'EDGE_AVOIDING', 'OIDN'])
    def test_each_denoiser(self, primitive, name):
        primitive.panoptes.denoise.final, primitive.panoptes.denoise.denoiser = True, name
        assert final()[0]['denoise'] == name.lower()

    def test_real_time_has_none(self, scene):
        scene.panoptes.denoise.final, scene.panoptes.method = True, 'realtime'
        assert 'denoise' not in final()[0]

    def test_3d_views_have_it_by_themselves(self, primitive):
        assert denoising.settings(primitive, viewport=True) == {'denoise': 'auto'}
        primitive.panoptes.denoise.viewport = False
        assert denoising.settings(primitive, viewport=True) == {}

    def test_parts_are_left_alone_and_a_sentence_says_so(self, primitive):
        primitive.panoptes.denoise.final = True
        settings, said = final(part=True)
        assert 'denoise' not in settings and said == [denoising.MERGED]

    def test_previews_have_none(self, primitive):
        primitive.panoptes.denoise.final = True
        assert 'denoise' not in requests.preview(bpy.context.evaluated_depsgraph_get())['settings']


class TestNoisyImage:
    """The pass that keeps what was there before."""

    def test_only_where_there_is_something_to_keep(self, primitive):
        layer = primitive.view_layers[0]
        passes.enable_all(layer, 'primitive')
        assert not layer.panoptes.use_pass_noisy_image
        primitive.panoptes.denoise.final = True
        passes.enable_all(layer, 'primitive')
        assert layer.panoptes.use_pass_noisy_image

    def test_is_the_picture_without_a_denoiser(self, primitive, tmp_path):
        settings, layer = primitive.panoptes, primitive.view_layers[0]
        settings.samples, settings.denoise.denoiser = 4, 'EDGE_AVOIDING'
        layer.panoptes.use_pass_noisy_image = True
        bpy.ops.mesh.primitive_plane_add(size=8.0)
        bpy.ops.mesh.primitive_cube_add(size=1.0, location=(0.0, 0.0, 1.0))
        bpy.ops.object.light_add(type='AREA', radius=3.0, location=(2.0, 0.0, 4.0))
        pictures = {}
        for denoised in (False, True):
            settings.denoise.final = denoised
            pictures[denoised] = render_passes(primitive, tmp_path)
        effect = next(e for e in json.loads(settings.last_stats)['effects'] if e['name'] == 'denoiser')
        assert effect['runs'] and not session.last_stats['warnings']
        noisy, plain = pictures[True]['Noisy Image'], pictures[False]['Combined']
        assert np.array_equal(noisy, plain) and np.array_equal(noisy, pictures[False]['Noisy Image'])
        assert not np.array_equal(pictures[True]['Combined'], noisy)
