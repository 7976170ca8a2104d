# SPDX-License-Identifier: GPL-3.0-or-later
"""Ambient occlusion: which settings reach the native side, from where it looks, and what is shown of it."""

import math
import os
import types

import bpy
import numpy as np
import pytest

from building import add_object, cube
from panoptes import changeover, native, occlusion, panels, passes, pieces, requests, session
from panoptes.cli import options
from panoptes.cli.failure import Failure
from panoptes.refinement import Refinement
from test_engine import ground, lamp, render_combined, render_passes, world
from test_paths import final, viewport
from test_user_interface import draw

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PICTURES = ('weights', 'samples', 'contribution', 'bent_normals', 'single_view', 'multiview')


@pytest.fixture
def ours(scene):
    """The settings of ambient occlusion of an empty scene."""
    return scene.panoptes.ambient_occlusion


def sent(warn=pytest.fail):
    """Return the `occlusion` of a final render's request."""
    return final(warn)['settings']['occlusion']


def add_camera(views, name, x=0.0):
    """Add a camera to a collection, looking down from (x, 0, 0)."""
    thing = bpy.data.objects.new(name, bpy.data.cameras.new(name))
    thing.location.x = x
    views.objects.link(thing)
    return thing


class TestSettings:
    """What is asked of the native side."""

    def test_defaults(self, ours):
        assert sent() == {
            'estimator': 'alchemy', 'distance': 10.0, 'strength': 1.0, 'samples': 15, 'importance_sampling': True,
            'initial_samples': 5, 'secondary_views': 2, 'phantoms': 'auto', 'phantom_resolution': 256,
            'phantom_cameras': [], 'filter': 'auto', 'deep_shadows': 0.0, 'picture': 'none'}

    @pytest.mark.parametrize('name, value', [
        ('estimator', 'SSAO'), ('estimator', 'HBAO'), ('distance', 0.5), ('strength', 0.25), ('samples', 30),
        ('importance_sampling', False), ('initial_samples', 7), ('secondary_views', 0), ('phantoms', 'OFF'),
        ('phantoms', 'ON'), ('phantom_resolution', 512), ('filter', 'OFF'), ('filter', 'ON'),
        ('deep_shadows', 0.75)])
    def test_values(self, ours, name, value):
        before = sent()
        setattr(ours, name, value)
        expected = {**before, name: value.lower() if isinstance(value, str) else value}
        assert before != expected and sent() == expected
        assert viewport()['settings']['occlusion'] == expected

    def test_every_setting_is_sent(self, ours):
        assert {p.identifier for p in ours.bl_rna.properties} - {'rna_type', 'name'} == set(sent()) - {'picture'}

    def test_paths_get_the_distance_alone(self, scene, ours):
        scene.panoptes.method, ours.distance = 'primitive', 3.0
        settings = final()['settings']
        assert settings['ao_distance'] == 3.0 and 'occlusion' not in settings
        # In the 3D View the picture begins with Real-time.
        assert viewport()['settings']['occlusion']['distance'] == 3.0

    def test_previews_have_none(self, scene, ours):
        request = requests.preview(bpy.context.evaluated_depsgraph_get())
        assert request['settings']['occlusion'] == {'strength': 0.0}

    def test_files_from_before(self, native_module):
        bpy.ops.wm.open_mainfile(filepath=os.path.join(ROOT, 'blend_scenes', 'atrium.blend'))
        ours = bpy.context.scene.panoptes.ambient_occlusion
        for prop in ours.bl_rna.properties:
            if prop.type not in ('STRING', 'POINTER'):
                assert getattr(ours, prop.identifier) == prop.default
        assert ours.phantom_cameras is None

    def test_saved_and_loaded(self, ours, tmp_path):
        ours.estimator, ours.deep_shadows = 'HBAO', 0.5
        ours.phantom_cameras = bpy.data.collections.new('Views')
        path = str(tmp_path / 'saved.blend')
        bpy.ops.wm.save_as_mainfile(filepath=path, check_existing=False)
        bpy.ops.wm.read_factory_settings(use_empty=True)
        bpy.ops.wm.open_mainfile(filepath=path)
        ours = bpy.context.scene.panoptes.ambient_occlusion
        assert (ours.estimator, ours.deep_shadows, ours.phantom_cameras.name) == ('HBAO', 0.5, 'Views')


class TestDistance:
    """How far occluders are looked for: one distance for both methods, always above 0."""

    @pytest.mark.parametrize('own, of_world, expected', [
        (0.0, None, 10.0), (0.0, 2.5, 2.5), (4.0, 2.5, 4.0), (4.0, None, 4.0), (math.nan, 2.5, 2.5),
        (-1.0, None, 10.0), (1e-30, None, 1e-6), (math.inf, None, 1e6), (0.0, 1e-20, 1e-6), (0.0, 3e38, 1e6),
        # As in Cycles: to the end of the scene.
        (0.0, 0.0, 1e6), (0.0, math.nan, 1e6)])
    def test_resolved(self, scene, ours, own, of_world, expected):
        ours.distance = own
        if of_world is not None:
            scene.world = bpy.data.worlds.new('World')
            scene.world.light_settings.distance = of_world
        assert occlusion.distance(scene) == pytest.approx(expected)
        assert sent()['distance'] == pytest.approx(expected)
        scene.panoptes.method = 'primitive'
        assert final()['settings']['ao_distance'] == pytest.approx(expected)


class TestPhantomCameras:
    """A collection of cameras in place of the pair."""

    @pytest.fixture
    def views(self, scene, ours):
        """The chosen collection, empty, in a scene of 32x24 pixels."""
        ours.phantom_cameras = found = bpy.data.collections.new('Views')
        scene.collection.children.link(found)
        return found

    @staticmethod
    def places(warn=pytest.fail):
        """Return where the cameras of a request stand along x."""
        return [-camera['view'][0][3] for camera in sent(warn)['phantom_cameras']]

    def test_empty_is_the_pair(self, views):
        assert self.places() == []

    def test_by_name(self, views):
        for name, x in (('C', 3.0), ('A', 1.0), ('B', 2.0)):
            add_camera(views, name, x)
        assert self.places() == [1.0, 2.0, 3.0]

    def test_collections_inside(self, views):
        inside = bpy.data.collections.new('Inside')
        views.children.link(inside)
        add_camera(inside, 'A', 1.0)
        assert self.places() == [1.0]

    def test_no_more_than_four(self, views):
        for x in range(6):
            add_camera(views, f'{x}', float(x))
        said = []
        assert self.places(said.append) == [0.0, 1.0, 2.0, 3.0]
        assert len(said) == 1 and "'Views'" in said[0] and 'first by name' in said[0]

    def test_what_is_no_camera(self, views):
        add_camera(views, 'A', 1.0)
        views.objects.link(cube())
        said = []
        assert self.places(said.append) == [1.0]
        assert len(said) == 1 and "'Cube'" in said[0] and "'Views'" in said[0]
        for index in range(5):
            views.objects.link(add_object(None, f'Empty {index}'))
        said = []
        self.places(said.append)
        assert len(said) == 1 and '3 more' in said[0]

    def test_panorama(self, views):
        add_camera(views, 'A').data.type = 'PANO'
        said = []
        assert self.places(said.append) == [0.0]
        assert len(said) == 1 and "'A' is panoramic" in said[0]

    def test_nowhere(self, views):
        add_camera(views, 'A', math.nan)
        add_camera(views, 'B', 2.0)
        said = []
        assert self.places(said.append) == [2.0]
        assert len(said) == 1 and "'A'" in said[0] and 'not a number' in said[0]

    def test_animation(self, scene, views):
        camera = add_camera(views, 'A')
        for frame, x in ((1, 0.0), (11, 10.0)):
            camera.location.x = x
            camera.keyframe_insert('location', frame=frame)
        for frame, x in ((1, 0.0), (11, 10.0), (1, 0.0)):
            scene.frame_set(frame)
            assert self.places() == pytest.approx([x])

    def test_deleted(self, scene, views):
        add_camera(views, 'A', 1.0)
        bpy.data.objects.remove(add_camera(views, 'B', 2.0))
        assert self.places() == [1.0]
        bpy.data.collections.remove(views)
        assert scene.panoptes.ambient_occlusion.phantom_cameras is None and self.places() == []

    def test_matrices(self, scene, views):
        camera = add_camera(views, 'A')
        camera.location, camera.scale = (1.0, 2.0, 3.0), (5.0, 5.0, 5.0)
        camera.data.angle, camera.data.clip_start, camera.data.clip_end = math.radians(90.0), 0.5, 20.0
        (found,) = sent()['phantom_cameras']
        # Its scale does not count; it looks down, with the picture's aspect.
        assert np.array(found['view']) @ (1.0, 2.0, 0.0, 1.0) == pytest.approx((0.0, 0.0, -3.0, 1.0))
        for place, clip in (((0.5, 0.0, -0.5), (1.0, 0.0, -1.0)), ((0.0, 15.0, -20.0), (0.0, 1.0, 1.0))):
            x, y, z, w = np.array(found['projection']) @ (*place, 1.0)
            assert (x / w, y / w, z / w) == pytest.approx(clip, abs=1e-5)
        # What two views differ by is seen by a 3D View, however little it is.
        before = viewport()
        camera.location.x += 1e-5
        assert repr(before['settings']) != repr(viewport()['settings'])

    def test_orthographic(self, scene, views):
        camera = add_camera(views, 'A')
        camera.data.type, camera.data.ortho_scale = 'ORTHO', 8.0
        (found,) = sent()['phantom_cameras']
        assert np.array(found['projection']) @ (4.0, 3.0, -1.0, 1.0) == pytest.approx((1.0, 1.0, -0.98, 1.0), abs=0.02)

    def test_merge_key(self, views, native_module):
        add_camera(views, 'A', 1.0)
        key = pieces.merge_key(bpy.context.scene, final())
        assert '"occlusion distance": 10.0' in key and '"occlusion phantom cameras": [{' in key


class TestPictures:
    """Pictures of occlusion in place of the scene."""

    @pytest.mark.parametrize('method', ['auto', 'primitive'])
    @pytest.mark.parametrize('picture', PICTURES)
    def test_request(self, scene, picture, method):
        scene.panoptes.samples, scene.panoptes.method = 7, method
        scene.panoptes.debug_picture = f'occlusion_{picture}'
        for request, samples in ((final(), (0, 7)), (viewport(), (0, 16))):
            assert request['settings']['occlusion']['picture'] == picture
            assert 'debug_picture' not in request['settings'] and 'structure' not in request['settings']
            assert request['method'] == 'realtime' and request['samples'] == samples
            assert isinstance(changeover.picture(request, 'key'), Refinement)

    def test_pictures_of_rays_are_none(self, scene):
        scene.panoptes.debug_picture = 'steps'
        settings = final()['settings']
        assert settings['debug_picture'] == 'steps' and settings['occlusion']['picture'] == 'none'

    def test_nothing_is_said_about_what_they_do_not_show(self, scene, recorder):
        scene.panoptes.method, scene.panoptes.debug_picture = 'primitive', 'occlusion_weights'
        scene.camera.data.dof.use_dof = True
        scene.view_layers[0].use_pass_diffuse_indirect = True
        bpy.ops.render.render()
        assert session.last_stats['warnings'] == []


class TestPanels:
    """What artists are shown."""

    def test_real_time(self, scene, ours):
        scene.world = bpy.data.worlds.new('World')
        drawn = draw('PANOPTES_PT_occlusion') + draw('PANOPTES_PT_occlusion_views')
        settings = {p.identifier for p in ours.bl_rna.properties} - {'rna_type', 'name'}
        assert set(drawn) == settings and drawn.count('distance') == 2
        ours.distance, ours.estimator, ours.phantoms = 1.0, 'HBAO', 'OFF'
        drawn = draw('PANOPTES_PT_occlusion') + draw('PANOPTES_PT_occlusion_views')
        assert drawn.count('distance') == 1
        assert not {'samples', 'importance_sampling', 'initial_samples', 'phantom_resolution'} & set(drawn)

    def test_phantom_cameras_take_the_place_of_the_pair(self, ours):
        ours.phantoms, ours.phantom_cameras = 'OFF', bpy.data.collections.new('Views')
        assert draw('PANOPTES_PT_occlusion_views') == ['secondary_views', 'phantom_cameras', 'phantoms']
        add_camera(ours.phantom_cameras, 'A')
        assert draw('PANOPTES_PT_occlusion_views') == ['secondary_views', 'phantom_cameras', 'phantom_resolution']

    def test_paths(self, scene, ours):
        scene.panoptes.method = 'primitive'
        context = types.SimpleNamespace(engine='PANOPTES', scene=scene, view_layer=scene.view_layers[0])
        assert not any(panel.poll(context) for panel in panels.occlusion_panels.CLASSES)
        scene.view_layers[0].use_pass_ambient_occlusion = True
        assert draw('PANOPTES_PT_occlusion') == ['distance']
        assert not bpy.types.PANOPTES_PT_occlusion_views.poll(context)

    def test_ray_structures_are_not_offered_for_occlusion(self, scene):
        scene.panoptes.debug_picture = 'occlusion_weights'
        assert draw('PANOPTES_PT_debug') == ['debug_picture']

    def test_pass_is_offered(self, scene):
        assert 'use_pass_ambient_occlusion' in draw('PANOPTES_PT_passes')
        assert passes.BY_NAME['AO'] in passes.filled_by('realtime')


class TestCommandLine:
    """--set ambient_occlusion.NAME=VALUE."""

    @staticmethod
    def assign(scene, *assignments):
        nothing = dict.fromkeys(('method', 'samples', 'bounces', 'seed', 'time_budget', 'noise_threshold', 'size',
                                 'frame', 'force_all_effects'))
        options.apply(types.SimpleNamespace(**nothing, assignments=assignments), scene)

    def test_values(self, scene, ours):
        views = bpy.data.collections.new('My Views')
        self.assign(scene, *((f'ambient_occlusion.{name}', value) for name, value in (
            ('estimator', 'HBAO'), ('distance', '0.5'), ('secondary_views', '1'), ('importance_sampling', 'off'),
            ('phantoms', 'ON'), ('phantom_cameras', 'My Views'))))
        assert (ours.estimator, ours.distance, ours.secondary_views) == ('HBAO', 0.5, 1)
        assert (ours.importance_sampling, ours.phantoms, ours.phantom_cameras) == (False, 'ON', views)

    @pytest.mark.parametrize('name, value', [('estimator', 'alchemy'), ('distance', '-1'), ('distance', 'nan'),
                                             ('secondary_views', '9'), ('phantom_cameras', 'Nowhere'),
                                             ('estimators', 'HBAO')])
    def test_bad_values(self, scene, name, value):
        with pytest.raises(Failure, match=name):
            self.assign(scene, (f'ambient_occlusion.{name}', value))


class TestForReal:
    """Pictures from the native module."""

    @pytest.fixture(autouse=True)
    def _needs_native(self, native_module):
        native.use_factory(None)

    @pytest.fixture
    def yard(self, scene):
        """Rows of cubes on a floor under a grey sky and a sun, seen from above; 64x48 pixels."""
        ground()
        for x in range(-2, 3):
            for y in range(-1, 2):
                bpy.ops.mesh.primitive_cube_add(size=1.0, location=(1.5 * x, 1.7 * y, 0.5))
        lamp('SUN', 1.0)
        world((0.5, 0.5, 0.5))
        scene.world.light_settings.distance = 2.0
        scene.view_layers[0].use_pass_ambient_occlusion = True
        scene.render.resolution_x, scene.render.resolution_y = 64, 48
        scene.panoptes.samples = 8
        return scene

    def test_pass_resembles_that_of_rays(self, yard, tmp_path):
        estimates = []
        for estimator in ('ALCHEMY', 'SSAO', 'HBAO'):
            yard.panoptes.ambient_occlusion.estimator = estimator
            estimates.append(render_passes(yard, tmp_path)['AO'])
        yard.panoptes.method, yard.panoptes.samples = 'primitive', 64
        rays = render_passes(yard, tmp_path)['AO']
        # Something is hidden, and not all of it: black, white and the inverse are farther off.
        assert all(np.abs(rays - other).mean() > 0.3 for other in (0.0, 1.0, 1.0 - rays))
        for ours in estimates:
            assert np.abs(ours - rays).mean() < 0.25 and np.corrcoef(ours.ravel(), rays.ravel())[0, 1] > 0.85

    def test_world_is_darkened(self, yard, tmp_path):
        yard.panoptes.radiance_cache.enabled = False
        dark = render_combined(yard, tmp_path)
        yard.panoptes.ambient_occlusion.strength = 0.0
        bright = render_combined(yard, tmp_path)
        assert (dark <= bright + 1e-4).all() and dark[..., :3].mean() < 0.95 * bright[..., :3].mean()
        # The top of the cube in the middle is open.
        assert dark[24, 32, :3] == pytest.approx(bright[24, 32, :3], rel=0.05)

    def test_each_picture_shows_something_else(self, yard, tmp_path):
        pictures = [render_combined(yard, tmp_path)]
        for picture in PICTURES:
            yard.panoptes.debug_picture = f'occlusion_{picture}'
            found = render_combined(yard, tmp_path)
            assert not session.last_error and np.isfinite(found).all() and found[..., :3].max() > 0.0
            assert all(not np.allclose(found, other, atol=1e-3) for other in pictures)
            pictures.append(found)

    def test_nothing_is_left_of_a_picture(self, yard, tmp_path):
        before = render_combined(yard, tmp_path)
        yard.panoptes.debug_picture = 'occlusion_weights'
        render_combined(yard, tmp_path)
        yard.panoptes.debug_picture = 'none'
        assert np.array_equal(render_combined(yard, tmp_path), before)

    def test_every_setting_is_known(self, yard):
        ours = yard.panoptes.ambient_occlusion
        ours.phantom_cameras = bpy.data.collections.new('Views')
        add_camera(ours.phantom_cameras, 'A').location.z = 8.0
        for estimator in ('ALCHEMY', 'SSAO', 'HBAO'):
            ours.estimator = estimator
            bpy.ops.render.render()
            assert not session.last_error and not session.last_stats['warnings']
