# SPDX-License-Identifier: GPL-3.0-or-later
"""Final renders through Blender: passes, statistics, errors; with the recorder and for real."""

import json
import math
import types

import bpy
import numpy as np
import pytest
from mathutils import Matrix

from panoptes import compat, final, native, passes, requests, session
from panoptes.time_left import TimeLeft, clock
from recorder import Job


def lamp(kind='SUN', energy=1.0, location=(0, 0, 5)):
    light = bpy.data.lights.new('Lamp', kind)
    light.energy = energy
    thing = bpy.data.objects.new('Lamp', light)
    thing.location = location
    bpy.context.scene.collection.objects.link(thing)
    return light


def ground(size=20.0):
    bpy.ops.mesh.primitive_plane_add(size=size)
    return bpy.context.object


def world(color, strength=1.0):
    found = bpy.context.scene.world = bpy.data.worlds.new('World')
    found.use_nodes = True
    node = next(n for n in found.node_tree.nodes if n.type == 'BACKGROUND')
    node.inputs['Color'].default_value = (*color, 1.0)
    node.inputs['Strength'].default_value = strength


def render_combined(scene, tmp_path):
    """Render; return the scene-linear picture, float32[H, W, 4], row 0 at the top."""
    compat.set_file_format(scene.render.image_settings, 'OPEN_EXR')
    scene.render.image_settings.color_depth = '32'
    scene.render.image_settings.color_mode = 'RGBA'
    scene.render.filepath = str(tmp_path / 'combined.exr')
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    pixels = np.empty((image.size[1], image.size[0], 4), np.float32)
    image.pixels.foreach_get(pixels.reshape(-1))
    bpy.data.images.remove(image)
    return pixels[::-1]


def render_passes(scene, tmp_path):
    """Render to an EXR; return {pass name: float32[H, W, C]}, row 0 at the top."""
    oiio = pytest.importorskip('OpenImageIO')
    compat.set_file_format(scene.render.image_settings, 'OPEN_EXR_MULTILAYER')
    scene.render.image_settings.color_depth = '32'
    scene.render.filepath = str(tmp_path / 'out.exr')
    bpy.ops.render.render(write_still=True)
    source = oiio.ImageInput.open(scene.render.filepath)
    assert source is not None, oiio.geterror()
    spec = source.spec()
    pixels = np.asarray(source.read_image(0, 0, 0, spec.nchannels, oiio.FLOAT))
    found = {}
    for index, channel in enumerate(spec.channelnames):
        _, name, letter = channel.split('.')
        found.setdefault(name, {})[letter] = pixels[..., index]
    source.close()
    order = 'RGBAXYZ'
    return {name: np.stack([channels[c] for c in sorted(channels, key=order.index)], axis=-1)
            for name, channels in found.items()}


class TestWithRecorder:
    """What is asked of the native side and what becomes of its answer."""

    def test_request(self, scene, recorder):
        scene.panoptes.samples, scene.panoptes.first_sample = 5, 3
        scene.panoptes.time_budget, scene.panoptes.noise_threshold = 2.5, 0.25
        scene.panoptes.realtime.shadow_resolution = 512
        scene.view_layers[0].use_pass_normal = True
        bpy.ops.render.render()
        (request,) = recorder.arguments('render')[0]
        assert (request['width'], request['height']) == (32, 24)
        assert request['samples'] == (3, 8) and request['method'] == 'realtime'
        assert request['settings']['time_budget'] == 2.5
        assert request['settings']['noise_threshold'] == 0.25
        assert request['settings']['shadow_resolution'] == 512
        assert {'Combined', 'Normal'} <= set(request['passes'])
        # The camera stands at z = 10 and looks down.
        assert np.allclose(request['view'] @ (0, 0, 0, 1), (0, 0, -10, 1))

    def test_limits_that_are_off_are_not_sent(self, scene, recorder):
        bpy.ops.render.render()
        settings = recorder.arguments('render')[0][0]['settings']
        assert 'time_budget' not in settings and 'noise_threshold' not in settings

    def test_border(self, scene, recorder):
        scene.render.use_border = True
        scene.render.border_min_x, scene.render.border_max_x = 0.5, 1.0
        scene.render.border_min_y, scene.render.border_max_y = 0.0, 0.5
        bpy.ops.render.render()
        (request,) = recorder.arguments('render')[0]
        assert (request['width'], request['height']) == (16, 12)
        # The middle of the frame is the upper left corner of the region.
        clip = request['projection'] @ (0, 0, -1, 1)
        assert np.allclose(clip[:2] / clip[3], (-1, 1))

    def test_percentage(self, scene, recorder):
        scene.render.resolution_percentage = 50
        bpy.ops.render.render()
        assert recorder.arguments('render')[0][0]['width'] == 16

    def test_statistics_reach_the_scene(self, scene, recorder):
        bpy.ops.render.render()
        stats = json.loads(scene.panoptes.last_stats)
        assert stats['size'] == [32, 24] and stats['sync_ms'] > 0 and stats['total_ms'] > 0
        assert session.last_stats == stats and not session.last_error

    def test_fragment_tracing_is_asked_for_with_its_settings(self, scene, recorder):
        scene.panoptes.method, scene.panoptes.fragment.storage = 'fragment', 'LLB'
        bpy.ops.render.render()
        request = recorder.arguments('render')[0][0]
        assert request['method'] == 'fragment' and request['settings']['fragments']['storage'] == 'LLB'

    def test_cancelled_renders_keep_what_there_is(self, scene, recorder, monkeypatch, tmp_path):
        """Passes that the job has not come to stay black."""
        scene.view_layers[0].use_pass_normal = True

        def read(job, name):
            if name != 'Combined':
                raise RuntimeError(f"pass '{name}' is not there yet")
            return np.full((24, 32, 4), 0.25, np.float32)

        monkeypatch.setattr(Job, 'read', read)
        monkeypatch.setattr(final, '_follow', lambda *arguments: True)
        found = render_passes(scene, tmp_path)
        assert (found['Combined'] == 0.25).all() and not found['Normal'].any()
        assert not session.last_error
        monkeypatch.setattr(final, '_follow', lambda *arguments: False)
        with pytest.raises(RuntimeError, match='not there yet'):
            bpy.ops.render.render()

    def test_time_left(self, scene, recorder, monkeypatch):
        told = []
        monkeypatch.setattr(session, 'progress_listener', lambda fraction, text: told.append(text))
        steps = iter((0.0, 0.25, 0.5))
        now = [100.0]

        def wait(job, seconds):
            job.share = next(steps, None)
            now[0] += 10.0
            return job.share is None

        monkeypatch.setattr(Job, 'wait', wait)
        monkeypatch.setattr(Job, 'progress', lambda job: job.share or 0.0)
        monkeypatch.setattr(final.time, 'monotonic', lambda: now[0])
        bpy.ops.render.render()
        assert told[1:4] == ['Finished', 'Finished, 1:00 left', 'Finished, 0:20 left']
        scene.panoptes.time_budget, scene.panoptes.noise_threshold = 35.0, 0.1
        steps = iter((0.25, 0.5))
        told.clear()
        bpy.ops.render.render()
        assert told[1:3] == ['Finished, at most 0:25 left', 'Finished, at most 0:15 left']

    def test_view_layers(self, scene, recorder):
        scene.view_layers.new('Second')
        bpy.ops.render.render()
        assert recorder.names().count('render') == 2

    def test_animation_sends_differences_only(self, scene, recorder):
        thing = ground()
        thing.keyframe_insert('location', frame=1)
        thing.location.x = 3
        thing.keyframe_insert('location', frame=2)
        scene.frame_set(1)
        bpy.ops.render.render()
        recorder.clear()
        scene.frame_set(2)
        bpy.ops.render.render()
        assert recorder.names() == ['set_instance_matrices', 'render']

    def test_native_error_becomes_the_message(self, scene, recorder):
        def refuse(*_):
            raise native.Unavailable('No driver; install one.')

        recorder.render = refuse
        with pytest.raises(RuntimeError, match='No driver; install one.'):
            bpy.ops.render.render()
        assert session.last_error == 'No driver; install one.'

    def test_unexpected_error_becomes_a_sentence(self, scene, recorder, capsys):
        def break_down(*_):
            raise KeyError('oops')

        recorder.render = break_down
        with pytest.raises(RuntimeError):
            bpy.ops.render.render()
        assert 'unexpected error (KeyError' in session.last_error
        # The next render is not affected.
        del recorder.render
        bpy.ops.render.render()
        assert not session.last_error


class TestForReal:
    """Pictures from the native module."""

    @pytest.fixture(autouse=True)
    def _needs_native(self, native_module):
        native.use_factory(None)

    def test_empty_scene_shows_the_world(self, scene, tmp_path):
        world((0.25, 0.5, 1.0), 2.0)
        picture = render_combined(scene, tmp_path)
        assert picture.shape == (24, 32, 4)
        assert np.allclose(picture, (0.5, 1.0, 2.0, 1.0), rtol=1e-3)

    def test_sun_on_a_diffuse_plane(self, scene, tmp_path):
        lamp('SUN', math.pi).angle = 0.0
        material = bpy.data.materials.new('Grey')
        material.use_nodes = True
        tree = material.node_tree
        diffuse = tree.nodes.new('ShaderNodeBsdfDiffuse')
        diffuse.inputs['Color'].default_value = (0.5, 0.25, 0.125, 1.0)
        output = next(n for n in tree.nodes if n.type == 'OUTPUT_MATERIAL')
        tree.links.new(diffuse.outputs[0], output.inputs['Surface'])
        ground().data.materials.append(material)
        passes.enable_all(scene.view_layers[0], 'realtime')
        found = render_passes(scene, tmp_path)
        assert set(found) == {entry.name for entry in passes.filled_by('realtime')}
        assert np.allclose(found['Combined'][12, 16], (0.5, 0.25, 0.125, 1.0), rtol=2e-3)
        assert np.allclose(found['DiffCol'][12, 16], (0.5, 0.25, 0.125), rtol=2e-3)
        assert np.allclose(found['DiffDir'][12, 16], 1.0, rtol=2e-3)
        assert np.allclose(found['Normal'][12, 16], (0, 0, 1), atol=2e-3)
        assert np.allclose(found['Depth'][12, 16], 10.0, rtol=1e-4)

    def test_orthographic_camera(self, scene, tmp_path):
        scene.camera.data.type = 'ORTHO'
        scene.camera.data.ortho_scale = 4.0
        ground(2.0)
        scene.view_layers[0].use_pass_z = True
        scene.render.filter_size = 0.01
        depth = render_passes(scene, tmp_path)['Depth'][..., 0]
        covered = depth < 100
        assert np.allclose(depth[covered], 10.0, rtol=1e-4)
        # A 2 m square in a frame 4 m wide: half its width of 32 pixels.
        assert covered.sum() == pytest.approx(16 * 16, abs=34)

    def test_generated_texture(self, scene, tmp_path):
        image = bpy.data.images.new('Made', 4, 4)
        image.pixels.foreach_set(np.tile(np.float32([0.5, 0.5, 0.5, 1.0]), 16))
        material = bpy.data.materials.new('Textured')
        material.use_nodes = True
        tree = material.node_tree
        texture, shine = (tree.nodes.new('ShaderNode' + n) for n in ('TexImage', 'Emission'))
        texture.image = image
        tree.links.new(texture.outputs[0], shine.inputs[0])
        output = next(n for n in tree.nodes if n.type == 'OUTPUT_MATERIAL')
        tree.links.new(shine.outputs[0], output.inputs['Surface'])
        ground().data.materials.append(material)
        picture = render_combined(scene, tmp_path)
        assert np.allclose(picture[12, 16, :3], 0.2140, rtol=0.02)

    def test_packed_texture(self, scene, tmp_path):
        image = bpy.data.images.new('Made', 4, 4)
        image.pixels.foreach_set(np.tile(np.float32([1.0, 0.0, 0.5, 1.0]), 16))
        image.filepath_raw, image.file_format = str(tmp_path / 'made.png'), 'PNG'
        image.save()
        image.pack()
        material = bpy.data.materials.new('Textured')
        material.use_nodes = True
        tree = material.node_tree
        texture, shine = (tree.nodes.new('ShaderNode' + n) for n in ('TexImage', 'Emission'))
        texture.image = image
        tree.links.new(texture.outputs[0], shine.inputs[0])
        output = next(n for n in tree.nodes if n.type == 'OUTPUT_MATERIAL')
        tree.links.new(shine.outputs[0], output.inputs['Surface'])
        ground().data.materials.append(material)
        picture = render_combined(scene, tmp_path)
        assert np.allclose(picture[12, 16, :3], (1.0, 0.0, 0.2140), rtol=0.02, atol=1e-3)

    def test_nan_vertices_and_missing_image(self, scene, tmp_path):
        world((1.0, 1.0, 1.0))
        thing = ground()
        thing.data.vertices.foreach_set('co', np.full(12, math.nan, np.float32))
        picture = render_combined(scene, tmp_path)
        assert np.allclose(picture, 1.0, rtol=1e-3)
        assert len(session.last_stats['warnings']) == 1

    def test_same_picture_twice(self, scene, tmp_path):
        world((0.5, 0.5, 0.5))
        lamp('POINT', 100.0)
        ground()
        scene.panoptes.samples = 3
        first = render_combined(scene, tmp_path)
        second = render_combined(scene, tmp_path)
        assert np.array_equal(first, second)

    def test_a_slider_compiles_nothing(self, scene):
        material = bpy.data.materials.new('Plain')
        material.use_nodes = True
        ground().data.materials.append(material)
        bpy.ops.render.render()
        before = native.engine().counters()['programs']
        node = next(n for n in material.node_tree.nodes if n.type == 'BSDF_PRINCIPLED')
        node.inputs['Roughness'].default_value = 0.9
        bpy.ops.render.render()
        assert native.engine().counters()['programs'] == before

    def test_another_engine_takes_the_place_of_one_whose_driver_failed(self, scene, tmp_path):
        world(color=(0.2, 0.4, 0.6))
        scene.camera.data.type = 'PERSP'
        before = render_combined(scene, tmp_path)
        failed = native.engine()
        request = {'width': 16384, 'height': 16384, 'samples': (0, 1), 'view': np.eye(4), 'projection': np.eye(4)}
        job = failed.render(request)
        assert job.wait(60.0) and failed.spoiled
        with pytest.raises(native.module().Error, match='could not allocate'):
            job.finish()
        assert (render_combined(scene, tmp_path) == before).all()
        assert native.engine() is not failed and not native.engine().spoiled

    def test_time_budget(self, scene):
        ground()
        scene.panoptes.samples = 100000
        scene.panoptes.time_budget = 0.5
        bpy.ops.render.render()
        assert 1 <= session.last_stats['samples'] < 100000
        assert session.last_stats['total_ms'] < 20000

    def test_no_camera(self, scene):
        scene.camera = None
        with pytest.raises(RuntimeError):
            bpy.ops.render.render()


def test_penumbrae_are_sampled_where_samples_are_many(scene):
    scene.camera = bpy.data.objects.new('camera', bpy.data.cameras.new('camera'))
    scene.collection.objects.link(scene.camera)
    region = types.SimpleNamespace(width=64, height=32)
    looking = types.SimpleNamespace(view_perspective='PERSP', view_matrix=Matrix(), window_matrix=Matrix())
    space = types.SimpleNamespace(use_render_border=False)

    def filtered(mode, samples=(16, 0), part=False):
        scene.panoptes.realtime.penumbrae = mode
        depsgraph = bpy.context.evaluated_depsgraph_get()
        scene.panoptes.samples, scene.panoptes.first_sample = samples
        final = requests.final(depsgraph, ['Combined'], pytest.fail, part)
        view, _ = requests.viewport(depsgraph, region, looking, space, 1, pytest.fail)
        return [request['settings']['filter_penumbrae'] for request in (final, view)]

    assert filtered('AUTO') == [False, True]
    assert filtered('SAMPLED') == [False, False]
    assert filtered('FILTERED') == [True, True]
    assert filtered('AUTO', (4, 0)) == [True, True]
    # Parts of a picture look as they do in the whole.
    assert filtered('AUTO', (4, 4)) == filtered('AUTO', (4, 0), part=True) == [False, True]
    assert filtered('SAMPLED', (4, 0)) == [False, False]


def test_pace_of_the_time_left():
    left = TimeLeft(started=0.0)
    assert left.seconds(0.0, 5.0) is None
    # The first of ten samples has waited for compiling.
    assert left.seconds(0.1, 20.0) == pytest.approx(180.0)
    assert left.seconds(0.1, 21.0) == pytest.approx(179.0)
    # Then each takes 2 s.
    assert left.seconds(0.2, 22.0) == pytest.approx(16.0)
    assert left.seconds(0.5, 28.0) == pytest.approx(10.0)
    assert left.seconds(0.5, 99.0) == 0.0 and left.seconds(1.0, 100.0) == 0.0
    assert [clock(seconds) for seconds in (0.4, 61.0, 3661.0)] == ['0:00', '1:01', '1:01:01']
