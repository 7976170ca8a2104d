# SPDX-License-Identifier: GPL-3.0-or-later
"""`scene.panoptes`: every option of a render, grouped by technique; and what view layers and objects have."""

import bpy
from bpy.props import (BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty,
                       StringProperty)

from . import denoising, fragment_tracing, occlusion_properties, radiance_cache_properties, specular_rays


class PanoptesRealtimeSettings(bpy.types.PropertyGroup):
    """Options of the Real-time method."""

    shadow_resolution: IntProperty(
        name='Shadow Resolution',
        description='Pixels along one side of a shadow map. More gives sharper shadows and takes '
                    'longer',
        default=2048, min=64, max=8192, soft_min=256, subtype='PIXEL')
    soft_shadows: BoolProperty(
        name='Soft Shadows',
        description='Give shadows of lamps that have an extent their penumbrae. Without it every lamp '
                    'is a point',
        default=True)
    penumbrae: EnumProperty(
        name='Penumbrae',
        description='How soft shadows are made',
        items=(
            ('AUTO', 'Automatic', 'Filtered in the 3D View and in final renders of fewer than 8 samples, '
                                  'sampled in others'),
            ('SAMPLED', 'Sampled', 'Each sample sees another point of the lamp: exact with many '
                                   'samples, and shadow maps are drawn anew for each'),
            ('FILTERED', 'Filtered', 'Shadows widen with the distance of what casts them: smooth and '
                                     'fast, but an estimate'),
        ),
        default='AUTO')


def _bounces(kind, what):
    """Return a limit for one kind of bounce.

    By default it is out of the way: the limit that counts is that of all bounces, which an artist can
    raise without looking for others. Lower ones make pictures darker, not only faster; dim paths end
    early by themselves.
    """
    return IntProperty(
        name=kind, description=f'How often light is {what} at most, where this is less than Bounces',
        default=1024, min=0, max=1024)


class PanoptesPrimitiveSettings(bpy.types.PropertyGroup):
    """Options of rays through triangles: the Primitive method and pictures of rays at work."""

    diffuse_bounces: _bounces('Diffuse', 'scattered by matt surfaces')
    glossy_bounces: _bounces('Glossy', 'reflected by shiny surfaces')
    transmission_bounces: _bounces('Transmission', 'refracted by glass')
    # Leaves stand in the way one behind the other, and where the limit is met they turn black.
    transparent_bounces: IntProperty(
        name='Transparent',
        description='Layers with transparency that light passes straight on. Behind so many it is dark. They do '
                    'not count as other bounces',
        default=16, min=0, max=1024)
    clamp_direct: FloatProperty(
        name='Clamp Direct',
        description='Most light that a sample may get from lamps and glowing things in one bounce. Lowers noise '
                    'and darkens highlights. 0 takes all of it',
        default=0.0, min=0.0, max=1e8, precision=2)
    clamp_indirect: FloatProperty(
        name='Clamp Indirect',
        description='Most light that a sample may get after several bounces. Lowers noise and darkens what is '
                    'seen by it. 0 takes all of it',
        default=0.0, min=0.0, max=1e8, precision=2)
    filter_glossy: FloatProperty(
        name='Filter Glossy',
        description='Blurs reflections that are seen by rough surfaces, where they would only be sparkles. 0 '
                    'keeps all of them sharp',
        default=1.0, min=0.0, max=10.0)
    shadows: EnumProperty(
        name='Lamp Shadows',
        description='How it is found what stands between a lamp and a surface',
        items=(
            ('RAYS', 'Rays', 'Exact'),
            ('MAPS', 'Shadow Maps', 'Faster where there are few lamps; as sharp as the maps are'),
        ),
        default='RAYS')
    primary: EnumProperty(
        name='Camera Rays',
        description='How it is found what the camera sees',
        items=(
            ('TRACED', 'Traced', 'Each sample looks through another place of each pixel and of the lens'),
            ('RASTERISED', 'Rasterised', 'Faster in scenes with few triangles. Each sample looks through the '
                                         'same place of all pixels, and everything is sharp'),
        ),
        default='TRACED')
    structure: EnumProperty(
        name='Structure',
        description="How rays find the triangles that they meet. The picture is the same with each but the "
                    "camera's view, the time is not",
        items=(
            ('auto', 'Automatic', 'What is expected to take the least time, by what each has taken so far'),
            ('orthographic', 'Orthographic View', 'One view along the shortest side of the scene: fast to '
                                                  'build, for geometry that moves'),
            ('cube', 'Cube', 'Six views around a centre'),
            ('lists', 'Cube, Linked Lists', 'Six views with the linked lists of the dissertation, to '
                                            'compare'),
            ('bvh', 'Hierarchy', 'A hierarchy of boxes: fast to trace, for geometry that rests'),
            ('view', "Camera's View", 'What the camera sees alone: fast, but no ray meets what is behind '
                                      'the camera or beside its view, so mirrors and shadows lack it'),
        ),
        default='auto')
    tiles: IntProperty(
        name='Tiles',
        description='Tiles along one side of a view, rounded up to a power of two. 0 follows the number '
                    'of triangles',
        default=0, min=0, max=1024)
    buckets: IntProperty(
        name='Buckets',
        description='Parts of a tile over depth: in all with linked lists, for each of its triangles '
                    'otherwise. 0 is what is usually fastest',
        default=0, min=0, max=255)


class PanoptesSceneSettings(bpy.types.PropertyGroup):
    """Options of a scene's renders."""

    method: EnumProperty(
        name='Method',
        description='How light is computed',
        items=(
            ('auto', 'Automatic', 'Choose the method that suits the scene'),
            ('realtime', 'Real-time', 'Rasterised light with shadow maps: for navigating and '
                                      'animation previews'),
            ('fragment', 'Fragment Tracing', 'Path tracing over rasterised layers: light after any number of '
                                             'bounces, as exact as their pixels'),
            ('primitive', 'Primitive Tracing', 'Path tracing with exact intersections: light after any '
                                               'number of bounces'),
        ),
        default='auto')
    samples: IntProperty(
        name='Samples', description='Samples a pixel in final renders', default=16, min=1,
        max=1 << 20, soft_max=4096)
    first_sample: IntProperty(
        name='First Sample',
        description='Number of the first sample, for renders that are split by samples', default=0,
        min=0, max=1 << 24)
    viewport_samples: IntProperty(
        name='Viewport Samples', description='Samples a pixel in the 3D View', default=16, min=1,
        max=1 << 20, soft_max=1024)
    viewport_budget: FloatProperty(
        name='Viewport Budget',
        description='How long each picture may take while the 3D View or the scene moves; its resolution drops '
                    'until it fits, and comes back at rest. 0 keeps the full resolution',
        default=0.1, min=0.0, soft_max=1.0, subtype='TIME', unit='TIME_ABSOLUTE')
    seed: IntProperty(
        name='Seed', description='Another seed gives another pattern of noise', default=0, min=0)
    bounces: IntProperty(
        name='Bounces',
        description='How often light is scattered on its way, by surfaces of all kinds. Real-time has a limit of '
                    'its own besides, under Indirect Light',
        default=8, min=0, max=1024)
    noise_threshold: FloatProperty(
        name='Noise Threshold',
        description='Stop when the estimated relative error falls below this. 0 renders all samples',
        default=0.0, min=0.0, max=1.0, precision=4)
    time_budget: FloatProperty(
        name='Time Budget',
        description='Stop after the sample that exceeds this many seconds. 0 renders all samples',
        default=0.0, min=0.0, subtype='TIME', unit='TIME_ABSOLUTE')
    exposure: FloatProperty(
        name='Exposure',
        description='Multiplies the light of all passes; colours, depth and normals stay',
        default=1.0, min=0.0, max=1e6, soft_max=10.0, precision=3)
    force_all_effects: BoolProperty(
        name='Force All Effects',
        description='Run every effect, also those that the scene cannot show. The picture stays the '
                    'same, the time does not',
        default=False)
    debug_picture: EnumProperty(
        name='Debug Picture',
        description='Show rays, ambient occlusion or indirect light at work in place of the scene; the view '
                    'transform Standard leaves the colours as they are. Numbers of rays are black 0, blue 3, cyan '
                    '15, green 63, yellow 255, red 1023 and white from 4095 on. Pictures of occlusion '
                    'and of indirect light are of those in Real-time, whatever the method, and become smoother '
                    'with samples',
        items=(
            ('none', 'None', 'Show the scene'),
            ('steps', 'Steps', "Nodes or cells that a pixel's ray visits"),
            ('tests', 'Tests', "Triangles that a pixel's ray is tested with"),
            ('lists', 'Lists', "Triangles in the longest list that a pixel's ray goes through"),
            ('tiles', 'Tiles', "The cell in which a pixel's ray ends, each in a colour of its own"),
            *occlusion_properties.PICTURES,
            *radiance_cache_properties.PICTURES,
        ),
        default='none')
    realtime: PointerProperty(type=PanoptesRealtimeSettings)
    primitive: PointerProperty(type=PanoptesPrimitiveSettings)
    ambient_occlusion: PointerProperty(type=occlusion_properties.PanoptesOcclusionSettings)
    radiance_cache: PointerProperty(type=radiance_cache_properties.PanoptesRadianceCacheSettings)
    specular_rays: PointerProperty(type=specular_rays.PanoptesSpecularRaysSettings)
    fragment: PointerProperty(type=fragment_tracing.PanoptesFragmentSettings)
    denoise: PointerProperty(type=denoising.PanoptesDenoiseSettings)
    last_stats: StringProperty(
        name='Last Statistics', description='Statistics of the last final render, as JSON',
        options={'HIDDEN', 'SKIP_SAVE'})


class PanoptesViewLayerSettings(bpy.types.PropertyGroup):
    """Options of a view layer that Blender has no place for."""

    use_pass_sample_count: BoolProperty(
        name='Sample Count', description='Deliver how many samples each pixel has got', default=False)
    use_pass_noisy_image: BoolProperty(
        name='Noisy Image', description='Deliver Combined as it was before it was denoised', default=False)


_CLASSES = (PanoptesRealtimeSettings, PanoptesPrimitiveSettings, occlusion_properties.PanoptesOcclusionSettings,
            radiance_cache_properties.PanoptesRadianceCacheSettings, specular_rays.PanoptesSpecularRaysSettings,
            fragment_tracing.PanoptesFragmentSettings, denoising.PanoptesDenoiseSettings, PanoptesSceneSettings,
            PanoptesViewLayerSettings, radiance_cache_properties.PanoptesObjectSettings)


def register():
    """Add `panoptes` to all scenes, view layers and objects."""
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Scene.panoptes = PointerProperty(type=PanoptesSceneSettings)
    bpy.types.ViewLayer.panoptes = PointerProperty(type=PanoptesViewLayerSettings)
    bpy.types.Object.panoptes = PointerProperty(type=radiance_cache_properties.PanoptesObjectSettings)


def unregister():
    """Remove `panoptes` from all scenes, view layers and objects."""
    del bpy.types.Object.panoptes
    del bpy.types.ViewLayer.panoptes
    del bpy.types.Scene.panoptes
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
