# SPDX-License-Identifier: GPL-3.0-or-later
"""Indirect light and specular rays of Real-time: which settings reach the native side, and what is shown of them."""

import math
import os
import types

import bpy
import numpy as np
import pytest

from building import add_object, cube, quad
from panoptes import changeover, final as final_renders, indirect_panels, native, passes, pieces, requests, session
from panoptes.cli import arguments, options
from panoptes.cli.failure import Failure
from panoptes.refinement import Refinement
from test_engine import ground, lamp, world
from test_paths import final, viewport
from test_user_interface import draw

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PICTURES = ('geometry', 'occupancy', 'lobes', 'light', 'clipped')


@pytest.fixture
def ours(scene):
    """The settings of the radiance cache of an empty scene."""
    return scene.panoptes.radiance_cache


def sent(warn=pytest.fail):
    """Return the `cache` of a final render's request."""
    return final(warn)['settings']['cache']


def names(group):
    return {p.identifier for p in group.bl_rna.properties} - {'rna_type', 'name'}


def assign(scene, *assignments, bounces=None):
    """Apply --set NAME=VALUE and --bounces as the command line does."""
    nothing = dict.fromkeys(('method', 'samples', 'seed', 'time_budget', 'noise_threshold', 'size', 'frame',
                             'force_all_effects'))
    options.apply(types.SimpleNamespace(**nothing, bounces=bounces, assignments=assignments), scene)


class TestSettings:
    """What is asked of the native side."""

    def test_defaults(self, ours):
        assert sent() == {
            'enabled': True, 'bounces': 2, 'resolution': 0, 'voxels': 4, 'cascades': 0, 'encoding': 'y3co2cg2',
            'luminance': 1.0, 'chrominance': 1.0, 'regions': [], 'first_bounce': 'surfaces', 'directions': 64,
            'march_steps': 0, 'voxel_fill': 0.75, 'occupancy': 'auto', 'depth_stride': 4, 'dilate': True,
            'rsm_samples': 200, 'rsm_resolution': 128, 'rsm_spread': pytest.approx(0.25), 'rsm_mixed': True,
            'blend': pytest.approx(0.8), 'rebuild_every': 1, 'picture': 'none'}
        assert final()['settings']['specular_rays'] == {'mode': 'auto', 'roughness': pytest.approx(0.3)}

    @pytest.mark.parametrize('name, value', [
        ('enabled', False), ('bounces', 0), ('bounces', 8), ('resolution', 24), ('voxels', 8), ('cascades', 3),
        ('encoding', 'Y3CO1CG1'), ('encoding', 'RGB2'), ('luminance', 0.5), ('chrominance', 0.0),
        ('first_bounce', 'RSM'), ('directions', 512), ('march_steps', 12), ('voxel_fill', 1.0),
        ('occupancy', 'DEPTH'), ('depth_stride', 1), ('dilate', False), ('rsm_samples', 4096),
        ('rsm_resolution', 1024), ('rsm_spread', 0.5), ('rsm_mixed', False), ('blend', 0.0),
        ('rebuild_every', 16)])
    def test_values(self, ours, name, value):
        before = sent()
        setattr(ours, name, value)
        expected = {**before, name: value.lower() if isinstance(value, str) else value}
        assert before != expected and sent() == expected
        assert viewport()['settings']['cache'] == expected

    def test_specular_rays(self, scene):
        scene.panoptes.specular_rays.mode, scene.panoptes.specular_rays.roughness = 'ON', 0.5
        for request in (final(), viewport()):
            assert request['settings']['specular_rays'] == {'mode': 'on', 'roughness': 0.5}

    def test_every_setting_is_sent(self, scene, ours):
        assert names(ours) - {'region_collection'} == set(sent()) - {'regions', 'picture'}
        assert names(scene.panoptes.specular_rays) == set(final()['settings']['specular_rays'])

    def test_out_of_range(self, ours):
        for name, low, high in (('bounces', 0, 8), ('resolution', 0, 64), ('voxels', 2, 8), ('cascades', 0, 3),
                                ('directions', 8, 512), ('luminance', 0.0, 100.0), ('blend', 0.0, 0.98)):
            for value, expected in ((-1, low), (1000000, high)):
                setattr(ours, name, value)
                assert sent()[name] == pytest.approx(expected), name

    def test_too_few_cells(self, ours):
        for cells in (1, 3):
            ours.resolution = cells
            said = []
            assert sent(said.append)['resolution'] == 4
            assert len(said) == 1 and f'{cells} cells' in said[0]
        ours.resolution = 4
        assert sent()['resolution'] == 4

    def test_bounces_of_all_methods_count_too(self, scene, ours):
        for of_all, own, expected in ((8, 2, 2), (1, 2, 1), (0, 8, 0), (1024, 8, 8)):
            scene.panoptes.bounces, ours.bounces = of_all, own
            assert sent()['bounces'] == expected

    def test_frames_of_views_follow_each_other(self, scene):
        for method in ('realtime', 'primitive'):
            scene.panoptes.method = method
            assert viewport()['viewport'] is True
            assert 'viewport' not in final()

    def test_paths_get_none(self, scene):
        scene.panoptes.method = 'primitive'
        assert not {'cache', 'specular_rays'} & set(final()['settings'])
        # In the 3D View the picture begins with Real-time.
        assert viewport()['settings']['cache']['enabled']
        assert viewport()['settings']['specular_rays']['mode'] == 'auto'

    def test_previews_have_none(self, scene):
        settings = requests.preview(bpy.context.evaluated_depsgraph_get())['settings']
        assert settings['cache'] == {'enabled': False} and settings['specular_rays'] == {'mode': 'off'}

    def test_files_from_before(self, native_module):
        bpy.ops.wm.open_mainfile(filepath=os.path.join(ROOT, 'blend_scenes', 'atrium.blend'))
        scene = bpy.context.scene
        for group in (scene.panoptes.radiance_cache, scene.panoptes.specular_rays, scene.objects[0].panoptes):
            for prop in group.bl_rna.properties:
                if prop.type not in ('STRING', 'POINTER'):
                    assert getattr(group, prop.identifier) == prop.default
        assert scene.panoptes.radiance_cache.region_collection is None

    def test_saved_and_loaded(self, scene, ours, tmp_path):
        ours.encoding, ours.luminance, scene.panoptes.specular_rays.mode = 'RGB3', 0.5, 'OFF'
        ours.region_collection = bpy.data.collections.new('Boxes')
        cube().panoptes.indirect_luminance = 0.25
        path = str(tmp_path / 'saved.blend')
        bpy.ops.wm.save_as_mainfile(filepath=path, check_existing=False)
        bpy.ops.wm.read_factory_settings(use_empty=True)
        bpy.ops.wm.open_mainfile(filepath=path)
        scene = bpy.context.scene
        ours = scene.panoptes.radiance_cache
        assert (ours.encoding, ours.luminance, ours.region_collection.name) == ('RGB3', 0.5, 'Boxes')
        assert scene.panoptes.specular_rays.mode == 'OFF'
        assert bpy.data.objects['Cube'].panoptes.indirect_luminance == 0.25

    def test_undo_and_redo(self, scene):
        bpy.context.view_layer.objects.active = cube()
        bpy.ops.ed.undo_push(message='before')
        scene.panoptes.radiance_cache.luminance = 0.5
        bpy.data.objects['Cube'].panoptes.indirect_luminance = 0.25
        bpy.ops.ed.undo_push(message='changed')

        def values():
            return (bpy.context.scene.panoptes.radiance_cache.luminance,
                    bpy.data.objects['Cube'].panoptes.indirect_luminance)
        bpy.ops.ed.undo()
        assert values() == (1.0, 1.0)
        bpy.ops.ed.redo()
        assert values() == (0.5, 0.25)

    def test_merge_key(self, ours, native_module):
        ours.resolution = 24
        key = pieces.merge_key(bpy.context.scene, final())
        assert '"cache resolution": 24' in key and '"specular rays mode": "auto"' in key


class TestPictures:
    """Pictures of indirect light in place of the scene."""

    @pytest.mark.parametrize('method', ['auto', 'primitive'])
    @pytest.mark.parametrize('picture', PICTURES)
    def test_request(self, scene, picture, method):
        scene.panoptes.samples, scene.panoptes.method = 7, method
        scene.panoptes.debug_picture = f'cache_{picture}'
        for request, samples in ((final(), (0, 7)), (viewport(), (0, 16))):
            settings = request['settings']
            assert settings['cache']['picture'] == picture and settings['occlusion']['picture'] == 'none'
            assert 'debug_picture' not in settings and 'structure' not in settings
            assert request['method'] == 'realtime' and request['samples'] == samples
            assert isinstance(changeover.picture(request, 'key'), Refinement)

    def test_other_pictures_are_none(self, scene):
        for other in ('steps', 'occlusion_weights'):
            scene.panoptes.debug_picture = other
            assert sent()['picture'] == 'none'


class TestPanels:
    """What artists are shown."""

    RENDER = ('PANOPTES_PT_indirect_light', 'PANOPTES_PT_indirect_cells', 'PANOPTES_PT_indirect_gathering')

    def test_real_time(self, ours):
        drawn = sum((draw(panel) for panel in self.RENDER), [])
        assert len(drawn) == len(set(drawn))
        shown = names(ours) - {'enabled'}
        maps = {name for name in shown if name.startswith('rsm_')}
        assert set(drawn) == shown - maps
        ours.first_bounce = 'RSM'
        assert set(draw(self.RENDER[2])) - set(drawn) == maps
        ours.occupancy = 'ALL'
        assert not {'depth_stride', 'dilate'} & set(draw(self.RENDER[1]))

    def test_the_limit_of_all_methods_is_shown_where_it_counts(self, scene, ours):
        assert draw(self.RENDER[0]).count('bounces') == 1
        scene.panoptes.bounces = 1
        assert draw(self.RENDER[0]).count('bounces') == 2

    def test_specular_rays(self, scene):
        assert draw('PANOPTES_PT_specular_rays') == ['mode', 'roughness']
        scene.panoptes.specular_rays.mode = 'ON'
        assert draw('PANOPTES_PT_specular_rays') == ['mode']

    def test_paths(self, scene):
        scene.panoptes.method = 'primitive'
        context = types.SimpleNamespace(engine='PANOPTES', scene=scene)
        assert not any(panel.poll(context) for panel in indirect_panels.CLASSES)

    def test_objects(self, scene):
        panel = bpy.types.PANOPTES_PT_object_indirect_light
        for thing in (add_object(quad()), add_object(None)):
            assert set(draw(panel.__name__, object=thing)) == names(thing.panoptes)
        for engine, thing in (('CYCLES', add_object(quad())), ('PANOPTES', scene.camera), ('PANOPTES', None)):
            assert not panel.poll(types.SimpleNamespace(engine=engine, object=thing))

    def test_passes_are_offered(self, scene):
        kinds = ('diffuse_indirect', 'glossy_indirect', 'transmission_indirect', 'transmission_direct',
                 'transmission_color')
        assert {f'use_pass_{kind}' for kind in kinds} <= set(draw('PANOPTES_PT_passes'))


class TestCommandLine:
    """--set radiance_cache.NAME=VALUE, --bounces N."""

    def test_values(self, scene, ours):
        boxes = bpy.data.collections.new('My Boxes')
        assign(scene, *((f'radiance_cache.{name}', value) for name, value in (
            ('resolution', '24'), ('encoding', 'RGB2'), ('luminance', '0.5'), ('dilate', 'off'),
            ('region_collection', 'My Boxes'))), ('specular_rays.mode', 'ON'))
        assert (ours.resolution, ours.encoding, ours.luminance, ours.dilate) == (24, 'RGB2', 0.5, False)
        assert ours.region_collection == boxes and scene.panoptes.specular_rays.mode == 'ON'

    def test_every_setting_has_a_name(self, scene, ours):
        keys = {f'radiance_cache.{name}' for name in names(ours)}
        assert keys | {'specular_rays.mode', 'specular_rays.roughness'} <= set(options._keys(scene.panoptes))

    @pytest.mark.parametrize('key, value', [
        ('radiance_cache.resolution', '65'), ('radiance_cache.encoding', 'y3co1cg1'), ('radiance_cache.blend', 'nan'),
        ('radiance_cache.region_collection', 'Nowhere'), ('radiance_cache.cells', '24'), ('specular_rays.mode', 'on')])
    def test_bad_values(self, scene, key, value):
        with pytest.raises(Failure, match=key):
            assign(scene, (key, value))

    @pytest.mark.parametrize('asked, expected', [(0, 0), (1, 1), (5, 5), (8, 8), (20, 8)])
    def test_bounces_that_are_asked_for(self, scene, ours, asked, expected):
        words = ['render', 'FILE', '-o', 'OUT', '--bounces', str(asked)]
        assign(scene, bounces=arguments.parse(words).bounces)
        assert sent()['bounces'] == expected and scene.panoptes.bounces == asked

    def test_the_more_precise_word_counts(self, scene, ours):
        assign(scene, ('radiance_cache.bounces', '1'), bounces=5)
        assert sent()['bounces'] == 1


class TestForReal:
    """What the native module makes of it."""

    @pytest.fixture(autouse=True)
    def _needs_native(self, native_module):
        native.use_factory(None)

    @pytest.fixture
    def yard(self, scene):
        """A cube on a floor under a grey sky and a lamp, 16x12 pixels."""
        scene.render.resolution_x, scene.render.resolution_y = 16, 12
        ground()
        cube()
        lamp('POINT', 100.0)
        world((0.5, 0.5, 0.5))
        return scene

    @staticmethod
    def run(request):
        """Return the statistics of a job over what the engine holds, which is nothing yet: its fastest scene."""
        job = native.engine().render(request)
        while not job.wait(1.0):
            pass
        job.finish()
        return job.stats()

    def test_every_choice_is_known(self, yard):
        ours = yard.panoptes.radiance_cache
        self.run(final())
        for group in (ours, yard.panoptes.specular_rays):
            for prop in group.bl_rna.properties:
                if prop.type == 'ENUM':
                    for item in prop.enum_items:
                        setattr(group, prop.identifier, item.identifier)
                        self.run(final())
                    setattr(group, prop.identifier, prop.default)
        ours.region_collection = bpy.data.collections.new('Boxes')
        ours.region_collection.objects.link(bpy.data.objects['Cube'])
        assert len(sent()['regions']) == 1
        self.run(final())
        for request in (viewport(), requests.preview(bpy.context.evaluated_depsgraph_get())):
            self.run(request)

    def test_values_are_those_of_the_plan(self, yard):
        def effects(request):
            return {effect['name']: effect for effect in self.run(request)['effects']}
        session.final_sync.sync(session.mirror(), bpy.context.evaluated_depsgraph_get(), incremental=False)
        assert effects(final())['radiance_cache']['runs']
        # Before paths take over.
        assert effects(changeover.quick(viewport()))['radiance_cache']['runs']
        assert not effects(final())['cache_rsm']['runs']
        yard.panoptes.radiance_cache.first_bounce = 'RSM'
        assert effects(final())['cache_rsm']['runs'] and not effects(final())['cache_first_bounce']['runs']
        yard.panoptes.radiance_cache.enabled = False
        assert effects(final())['radiance_cache']['reason'] == 'switched off in the settings'

    @pytest.mark.parametrize('technique, change, word', [
        ('cache', {'cells': 3}, "no setting 'cells'"), ('cache', {'encoding': 'y9'}, "cannot be 'y9'"),
        ('cache', {'bounces': 'two'}, "'bounces' has a value of the wrong type"),
        ('cache', {'bounces': 9}, '9 bounces'),
        ('cache', {'luminance': math.nan}, 'luminance'),
        ('cache', {'regions': [{'world_to_box': np.eye(4), 'luminance': 1.0, 'chrominance': 1.0}] * 9},
         '9 regions of indirect light are more than can be used'),
        ('cache', {'regions': [{'world_to_box': np.eye(4), 'brightness': 1.0}]}, "no setting 'brightness'"),
        ('cache', {'regions': [{'luminance': 1.0}]}, "'world_to_box' is missing"),
        ('specular_rays', {'mode': 'maybe'}, "cannot be 'maybe'"), ('specular_rays', {'rays': 2}, "no setting 'rays'"),
        ('occlusion', {'views': 2}, "ambient occlusion has no setting 'views'")])
    def test_what_is_unknown_is_a_sentence(self, yard, technique, change, word):
        request = final()
        request['settings'][technique].update(change)
        with pytest.raises(native.module().Error, match=word):
            self.run(request)

    def test_scales_of_objects(self, yard):
        thing = bpy.data.objects['Cube']
        thing.panoptes.indirect_luminance = 0.5
        bpy.ops.render.render()
        assert not session.last_error
        before = native.engine().counters()['programs']
        thing.panoptes.indirect_luminance = 0.25
        bpy.ops.render.render()
        assert not session.last_error and native.engine().counters()['programs'] == before

    def test_passes_of_indirect_light_are_no_reason_to_warn(self, yard):
        said = []
        asked = [passes.BY_NAME[name] for name in ('DiffInd', 'GlossInd', 'TransInd', 'Position')]
        final_renders._warn_of_black(asked, 'realtime', said.append)
        assert len(said) == 1 and 'Position' in said[0] and 'Ind' not in said[0]
