# SPDX-License-Identifier: GPL-3.0-or-later
"""What the add-on asks of paths of light: limits, lenses, passes; and what Real-time says it lacks."""

import math
import types

import bpy
import numpy as np
import pytest
from mathutils import Matrix

from building import add_object
from panoptes import passes, requests, session
from test_engine import render_passes


@pytest.fixture
def primitive(scene):
    """A scene whose paths are traced."""
    scene.panoptes.method = 'primitive'
    return scene


def final(warn=pytest.fail):
    """Return the request of a final render of the present scene."""
    return requests.final(bpy.context.evaluated_depsgraph_get(), ['Combined'], warn)


def viewport(perspective='CAMERA', warn=pytest.fail):
    """Return the request of a 3D View."""
    region = types.SimpleNamespace(width=64, height=32)
    looking = types.SimpleNamespace(view_perspective=perspective, view_matrix=Matrix(), window_matrix=Matrix(),
                                    perspective_matrix=Matrix())
    space = types.SimpleNamespace(use_render_border=False, use_local_camera=False)
    return requests.viewport(bpy.context.evaluated_depsgraph_get(), region, looking, space, 1, warn)[0]


class TestSettings:
    """What is sent with the method."""

    def test_only_paths_get_settings_of_paths(self, scene):
        settings = final()['settings']
        assert not {'bounces', 'clamp_direct', 'ao_distance', 'structure'} & set(settings)

    def test_values(self, primitive):
        primitive.world = bpy.data.worlds.new('World')
        primitive.world.light_settings.distance = 2.5
        ours = primitive.panoptes.primitive
        primitive.panoptes.bounces = 20
        ours.diffuse_bounces, ours.glossy_bounces, ours.transmission_bounces = 1, 2, 3
        ours.transparent_bounces, ours.clamp_direct, ours.clamp_indirect, ours.filter_glossy = 4, 5.0, 6.0, 0.25
        ours.shadows, ours.primary, ours.structure, ours.tiles = 'MAPS', 'RASTERISED', 'cube', 16
        for request in (final(), viewport()):
            assert request['method'] == 'primitive'
            assert request['settings'].items() >= {
                'bounces': 20, 'diffuse_bounces': 1, 'glossy_bounces': 2, 'transmission_bounces': 3,
                'transparent_bounces': 4, 'clamp_direct': 5.0, 'clamp_indirect': 6.0, 'filter_glossy': 0.25,
                'shadow_maps': True, 'raster_primary': True, 'structure': 'cube', 'tiles': 16,
                'ao_distance': 2.5}.items()

    def test_the_limit_of_all_bounces_is_the_one_that_counts(self, primitive):
        primitive.panoptes.bounces = 1000
        settings = final()['settings']
        assert all(settings[f'{kind}_bounces'] >= 1000 for kind in ('diffuse', 'glossy', 'transmission'))
        assert not settings['clamp_direct'] and not settings['clamp_indirect']

    def test_the_native_side_knows_every_setting(self, primitive, native_module):
        primitive.world = bpy.data.worlds.new('World')
        passes.enable_all(primitive.view_layers[0], 'primitive')
        bpy.ops.render.render()
        assert not session.last_error and not session.last_stats['warnings']


class TestLens:
    """Depth of field, by the conventions of Cycles."""

    @pytest.fixture
    def camera(self, primitive):
        """A camera at z = 10 that looks down, out of focus by default."""
        dof = primitive.camera.data.dof
        dof.use_dof, dof.focus_distance = True, 4.0
        dof.aperture_fstop, dof.aperture_blades = 0.5, 5
        dof.aperture_rotation, dof.aperture_ratio = 0.75, 2.0
        return primitive.camera

    def test_values(self, camera):
        camera.data.lens = 35.0
        lens = final()['lens']
        assert lens == pytest.approx({'radius': 0.035, 'focus_distance': 4.0, 'blades': 5, 'rotation': 0.75,
                                      'ratio': 2.0})
        # What the sensor's size is does not count, nor does the camera's scale.
        camera.data.sensor_width, camera.scale = 10.0, (2.0, 2.0, 2.0)
        assert final()['lens'] == lens

    def test_field_of_view_in_place_of_a_focal_length(self, camera):
        camera.data.lens_unit, camera.data.sensor_width = 'FOV', 36.0
        camera.data.angle = 2.0 * math.atan(0.5)
        # Half the sensor is half the focal length.
        assert final()['lens']['radius'] == pytest.approx(0.036)

    def test_orthographic(self, camera):
        camera.data.type = 'ORTHO'
        assert final()['lens']['radius'] == pytest.approx(1.0)

    def test_focus_object(self, camera):
        camera.data.dof.focus_object = add_object(None, 'There', location=(3.0, 5.0, 7.5))
        # Along the axis, which is z.
        assert final()['lens']['focus_distance'] == pytest.approx(2.5)
        camera.data.dof.focus_object.location.z = 10.0
        assert final()['lens']['focus_distance'] == pytest.approx(1e-5)

    def test_focus_bone(self, camera):
        armature = bpy.data.armatures.new('Rig')
        rig = add_object(armature, 'Rig', location=(0.0, 0.0, 1.0))
        bpy.context.view_layer.objects.active = rig
        bpy.ops.object.mode_set(mode='EDIT')
        bone = armature.edit_bones.new('Head')
        bone.head, bone.tail = (0.0, 0.0, 3.0), (0.0, 0.0, 4.0)
        bpy.ops.object.mode_set(mode='OBJECT')
        camera.data.dof.focus_object, camera.data.dof.focus_subtarget = rig, 'Head'
        assert final()['lens']['focus_distance'] == pytest.approx(6.0)
        camera.data.dof.focus_subtarget = 'Tail'
        assert final()['lens']['focus_distance'] == pytest.approx(9.0)

    def test_focus_nowhere(self, camera):
        camera.data.dof.focus_object = add_object(None, 'There', location=(0.0, 0.0, math.nan))
        said = []
        assert final(said.append)['lens'] == {} and 'focus' in said[0] and len(said) == 1

    def test_viewport(self, camera):
        assert viewport()['lens'] == final()['lens']
        assert viewport('PERSP')['lens'] == {}

    @pytest.mark.parametrize('change', [('method', 'realtime'), ('primitive.primary', 'RASTERISED')])
    def test_what_is_rasterised_is_sharp(self, camera, change):
        path, value = change
        ours = bpy.context.scene.panoptes
        *groups, name = path.split('.')
        setattr(getattr(ours, groups[0]) if groups else ours, name, value)
        for request in (final, viewport):
            said = []
            assert request(warn=said.append)['lens'] == {}
            assert len(said) == 1 and 'depth of field' in said[0]

    def test_sharp(self, primitive):
        assert final()['lens'] == {} and viewport()['lens'] == {}


class TestPasses:
    """Passes that only paths fill."""

    def test_every_pass_arrives(self, primitive, recorder, tmp_path):
        passes.enable_all(primitive.view_layers[0], 'primitive')
        found = render_passes(primitive, tmp_path)
        assert set(found) == {entry.name for entry in passes.PASSES} - {'Noisy Image'}
        assert set(recorder.arguments('render')[0][0]['passes']) == set(found)
        assert all(np.all(picture == 0.5) for picture in found.values())
        assert found['Debug Sample Count'].shape[2] == 1 and found['AO'].shape[2] == 3

    def test_real_time_leaves_them_black_and_says_so(self, scene, recorder, tmp_path):
        passes.enable_all(scene.view_layers[0], 'primitive')
        found = render_passes(scene, tmp_path)
        assert not found['Position'].any() and found['DiffInd'].all()
        assert 'Position' not in recorder.arguments('render')[0][0]['passes']
        (said,) = session.last_stats['warnings']
        assert 'Position, ' in said and 'DiffInd' not in said

    def test_what_is_not_asked_for_is_not_there(self, primitive, recorder, tmp_path):
        primitive.view_layers[0].use_pass_position = True
        assert set(render_passes(primitive, tmp_path)) == {'Combined', 'Position'}
