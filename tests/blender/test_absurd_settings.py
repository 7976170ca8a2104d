# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings that make no sense: a picture or a sentence, never an exception, a crash or what is not a number."""

import math

import bpy
import numpy as np
import pytest

from panoptes import native, session
from test_engine import ground, lamp, render_combined, world


def set_camera(**settings):
    def change(scene):
        for name, value in settings.items():
            setattr(scene.camera.data, name, value)
    return change


def set_render(**settings):
    def change(scene):
        for name, value in settings.items():
            setattr(scene.render, name, value)
    return change


def set_own(**settings):
    def change(scene):
        for name, value in settings.items():
            setattr(scene.panoptes, name, value)
    return change


def set_occlusion(**settings):
    def change(scene):
        scene.view_layers[0].use_pass_ambient_occlusion = True
        for name, value in settings.items():
            setattr(scene.panoptes.ambient_occlusion, name, value)
    return change


def set_cache(**settings):
    def change(scene):
        bpy.ops.mesh.primitive_cube_add(location=(0.0, 0.0, 1.0))
        for name, value in settings.items():
            setattr(scene.panoptes.radiance_cache, name, value)
    return change


def indirect_light_of_object(luminance, chrominance):
    def change(scene):
        bpy.ops.mesh.primitive_cube_add(location=(0.0, 0.0, 1.0))
        ours = bpy.context.object.panoptes
        ours.indirect_luminance, ours.indirect_chrominance = luminance, chrominance
    return change


def region(place=(0.0, 0.0, 0.0), scale=1.0):
    def change(scene):
        box = bpy.data.objects.new('Box', None)
        box.empty_display_type, box.location, box.scale = 'CUBE', place, (scale,) * 3
        box.panoptes.indirect_luminance = 0.5
        boxes = scene.panoptes.radiance_cache.region_collection = bpy.data.collections.new('Boxes')
        scene.collection.children.link(boxes)
        boxes.objects.link(box)
    return change


def occlusion_of_world(distance):
    def change(scene):
        scene.view_layers[0].use_pass_ambient_occlusion = True
        scene.world.light_settings.distance = distance
    return change


def phantom_camera(place=(0.0, 0.0, 5.0), scale=1.0, **settings):
    def change(scene):
        camera = bpy.data.objects.new('Phantom', bpy.data.cameras.new('Phantom'))
        camera.location, camera.scale = place, (scale,) * 3
        for name, value in settings.items():
            setattr(camera.data, name, value)
        views = scene.panoptes.ambient_occlusion.phantom_cameras = bpy.data.collections.new('Views')
        scene.collection.children.link(views)
        views.objects.link(camera)
        bpy.ops.mesh.primitive_cube_add(location=(0.0, 0.0, 1.0))
    return change


def set_place(**settings):
    def change(scene):
        for name, value in settings.items():
            setattr(scene.camera, name, value)
    return change


def set_light(kind, **settings):
    def change(scene):
        light = lamp(kind)
        for name, value in settings.items():
            setattr(light, name, value)
    return change


def other_camera(make):
    def change(scene):
        scene.camera = bpy.data.objects.new('Other', make())
        scene.collection.objects.link(scene.camera)
    return change


def odd_world(strength):
    return lambda scene: world((1.0, 1.0, 1.0), strength)


def no_world(scene):
    scene.world = None


def scaled_lamp(scene):
    lamp('AREA', 10.0)
    bpy.data.objects['Lamp'].scale = (0.0, -1.0, math.nan)


CASES = {
    'clipping the wrong way round': set_camera(clip_start=50.0, clip_end=1.0),
    'clipping at one depth': set_camera(clip_start=10.0, clip_end=10.0),
    'no depth at all': set_camera(clip_start=1e-6, clip_end=1e-6),
    'endless depth': set_camera(clip_start=1e-6, clip_end=3e38),
    'endless lens': set_camera(lens=1e30),
    'no lens': set_camera(lens=0.0),
    'no frame': set_camera(type='ORTHO', ortho_scale=0.0),
    'endless frame': set_camera(type='ORTHO', ortho_scale=3e38),
    'no sensor': set_camera(sensor_width=0.0, sensor_height=0.0),
    'far shift': set_camera(shift_x=1e20),
    'panorama': set_camera(type='PANO'),
    'long pixels': set_render(pixel_aspect_x=200.0, pixel_aspect_y=1.0),
    'no filter': set_render(filter_size=0.0),
    'wide filter': set_render(filter_size=500.0),
    'one per cent': set_render(resolution_percentage=1),
    'border inside out': set_render(use_border=True, border_min_x=0.8, border_max_x=0.2),
    'border without a pixel': set_render(use_border=True, border_min_x=0.501, border_max_x=0.502,
                                         border_min_y=0.501, border_max_y=0.502),
    'motion blur': set_render(use_motion_blur=True),
    'last samples': set_own(first_sample=1 << 24),
    'no exposure': set_own(exposure=0.0),
    'largest exposure': set_own(exposure=1e6),
    'largest seed': set_own(seed=2**31 - 1),
    'no time': set_own(time_budget=1e-9, samples=64),
    'any noise': set_own(noise_threshold=1.0, samples=64),
    'no camera': lambda scene: setattr(scene, 'camera', None),
    'camera without size': set_place(scale=(0.0, 0.0, 0.0)),
    'camera inside out': set_place(scale=(-1.0, 1.0, 1.0)),
    'camera nowhere': set_place(location=(math.nan, 0.0, 0.0)),
    'camera at the end of the world': set_place(location=(3e38, 0.0, 0.0)),
    'lamp as camera': other_camera(lambda: bpy.data.lights.new('Other', 'SPOT')),
    'mesh as camera': other_camera(lambda: bpy.data.meshes.new('Other')),
    'nothing as camera': other_camera(lambda: None),
    'endless light': set_light('POINT', energy=3e38),
    'light that is no number': set_light('SUN', energy=math.nan),
    'negative light': set_light('SPOT', energy=-100.0),
    'wide sun': set_light('SUN', energy=1.0, angle=math.pi),
    'no area': set_light('AREA', energy=1.0, size=0.0),
    'lamp without a size': scaled_lamp,
    'world that is no number': odd_world(math.nan),
    'bright world': odd_world(1e10),
    'no world': no_world,
    'occlusion by dust': set_occlusion(distance=1e-30),
    'occlusion by the universe': set_occlusion(distance=math.inf),
    'occlusion without end': occlusion_of_world(0.0),
    'occlusion of no distance': occlusion_of_world(math.nan),
    'occlusion of no strength at all': set_occlusion(strength=math.nan),
    'deep shadows that are no number': set_occlusion(deep_shadows=math.nan),
    'more samples to begin with than there are': set_occlusion(samples=1, initial_samples=256),
    'many samples of occlusion': set_occlusion(samples=256, importance_sampling=False, secondary_views=8),
    'the finest phantoms': set_occlusion(phantoms='ON', phantom_resolution=4096),
    'the coarsest phantoms': set_occlusion(phantoms='ON', phantom_resolution=16, estimator='HBAO'),
    'phantom nowhere': phantom_camera((math.nan, 0.0, 0.0)),
    'phantom at the end of the world': phantom_camera((3e38, 0.0, 0.0)),
    'phantom without size': phantom_camera(scale=0.0),
    'phantom inside out': phantom_camera(scale=-1.0),
    'phantom without depth': phantom_camera(clip_start=10.0, clip_end=10.0),
    'phantom with endless depth': phantom_camera(clip_start=1e-6, clip_end=3e38),
    'phantom without a lens': phantom_camera(lens=0.0),
    'phantom with an endless lens': phantom_camera(lens=1e30),
    'panoramic phantom': phantom_camera(type='PANO'),
    'phantom without a frame': phantom_camera(type='ORTHO', ortho_scale=0.0),
    'indirect light that is no number': set_cache(luminance=math.nan),
    'endless colour of indirect light': set_cache(chrominance=math.inf),
    'fewest cells': set_cache(resolution=1, voxels=2, directions=8),
    'finest cells': set_cache(resolution=64, voxels=8, cascades=3),
    'cells without walls': set_cache(voxel_fill=math.nan),
    'everything is kept': set_cache(blend=math.inf),
    'object with indirect light that is no number': indirect_light_of_object(math.nan, 1.0),
    'object with endless indirect light': indirect_light_of_object(math.inf, math.inf),
    'region nowhere': region((math.nan, 0.0, 0.0)),
    'region at the end of the world': region((3e38, 0.0, 0.0)),
    'region without size': region(scale=0.0),
    'region of dust': region(scale=1e-30),
    'region of the universe': region(scale=1e30),
    'region inside out': region(scale=-1.0),
    'reflections that are no number': lambda scene: setattr(scene.panoptes.specular_rays, 'roughness', math.nan),
}


# What Blender says before it asks an engine.
_BLENDERS_OWN = ('Image too small', 'Cannot render, no camera')


@pytest.mark.parametrize('change', CASES.values(), ids=CASES.keys())
def test_picture_or_sentence(scene, native_module, tmp_path, change):
    native.use_factory(None)
    world((0.5, 0.5, 0.5))
    ground(4.0)
    scene.panoptes.realtime.shadow_resolution = 64
    change(scene)
    try:
        picture = render_combined(scene, tmp_path)
    except RuntimeError as error:
        refused_by_blender = any(text in str(error) for text in _BLENDERS_OWN)
        assert refused_by_blender or session.last_error.endswith('.')
        assert 'unexpected' not in session.last_error
    else:
        assert not session.last_error and np.isfinite(picture).all()
    for sentence in (session.last_stats or {}).get('warnings', ()):
        assert sentence.endswith('.')


def test_picture_too_large_for_the_computer(scene, native_module):
    native.use_factory(None)
    scene.render.resolution_x = scene.render.resolution_y = 65536
    with pytest.raises(RuntimeError):
        bpy.ops.render.render()
    assert '65536x65536' in session.last_error and session.last_error.endswith('.')
    # The next one is not affected.
    scene.render.resolution_x = scene.render.resolution_y = 16
    bpy.ops.render.render()
    assert not session.last_error


def test_stereo_shows_the_camera_itself_to_both_eyes(scene, native_module, tmp_path):
    native.use_factory(None)
    world((0.25, 0.5, 1.0))
    scene.render.use_multiview = True
    scene.render.filepath = str(tmp_path / 'eye.png')
    bpy.ops.render.render(write_still=True)
    assert sorted(path.name for path in tmp_path.iterdir()) == ['eye_L.png', 'eye_R.png']
    assert len([w for w in session.last_stats['warnings'] if 'Stereoscopy' in w]) == 1


def test_filter_that_is_too_wide_is_narrowed(scene, recorder):
    scene.render.filter_size = 500.0
    bpy.ops.render.render()
    assert recorder.arguments('render')[0][0]['filter_width'] == 10.0
    assert any('filter' in sentence for sentence in session.last_stats['warnings'])
