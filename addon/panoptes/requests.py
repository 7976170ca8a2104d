# SPDX-License-Identifier: GPL-3.0-or-later
"""From scenes and views to the request dictionaries of the native engine."""

import numpy as np

from . import (cameras, debug_pictures, denoising, fragment_tracing, lens, occlusion, radiance_cache, specular_rays,
               view_shading)

# Enough for an icon; the larger previews are as small as a stamp, too.
_PREVIEW_SAMPLES = 16
# Fewer points of a lamp are seen apart in its shadows.
_LAMP_POINTS = 8
# Of the native engine.
_WIDEST_FILTER = 10.0


class BadRequest(RuntimeError):
    """The scene asks for something that cannot be rendered; the text says what and the remedy."""


def method(settings, viewport=False):
    """Return the method that is used for what `scene.panoptes` asks: 'realtime', 'fragment' or 'primitive'.

    Left to choose, a 3D View refines Real-time's pictures by paths.
    """
    wanted = settings.method
    if wanted == 'auto':
        wanted = 'primitive' if viewport else 'realtime'
    return 'realtime' if debug_pictures.shows_technique(settings) else wanted


def _path_settings(scene):
    """Return the settings of paths: limits, and how their rays find what they meet."""
    settings, paths = scene.panoptes, scene.panoptes.primitive
    found = {
        'bounces': settings.bounces,
        'clamp_direct': paths.clamp_direct,
        'clamp_indirect': paths.clamp_indirect,
        'filter_glossy': paths.filter_glossy,
        'shadow_maps': paths.shadows == 'MAPS',
        'raster_primary': paths.primary == 'RASTERISED',
        'ao_distance': occlusion.distance(scene),
        **_structure_settings(paths),
    }
    for kind in ('diffuse', 'glossy', 'transmission', 'transparent'):
        found[f'{kind}_bounces'] = getattr(paths, f'{kind}_bounces')
    return found


def _structure_settings(paths):
    return {name: getattr(paths, name) for name in ('structure', 'tiles', 'buckets')}


def _realtime_settings(depsgraph, warn):
    """Return the settings of the techniques of Real-time, each a dictionary."""
    return {
        'occlusion': occlusion.settings(depsgraph, warn),
        'cache': radiance_cache.settings(depsgraph, warn),
        'specular_rays': specular_rays.settings(depsgraph.scene),
    }


def _settings(depsgraph, used, viewport, warn):
    """Return the settings that count for a method in a 3D View or a final render."""
    scene, settings = depsgraph.scene, depsgraph.scene.panoptes
    found = {
        'shadow_resolution': settings.realtime.shadow_resolution,
        'soft_shadows': settings.realtime.soft_shadows,
        'filter_penumbrae': settings.realtime.penumbrae == 'FILTERED',
        'film_transparent': scene.render.film_transparent,
    }
    if used != 'realtime':
        found.update(_path_settings(scene))
        found.update(denoising.settings(scene, viewport))
        if used == 'fragment':
            found.update(fragment_tracing.settings(scene))
    else:
        found.update(_realtime_settings(depsgraph, warn))
    # 0 switches a limit off.
    if settings.time_budget > 0.0:
        found['time_budget'] = settings.time_budget
    if settings.noise_threshold > 0.0:
        found['noise_threshold'] = settings.noise_threshold
    if debug_pictures.shows_rays(settings):
        found['debug_picture'] = settings.debug_picture
        found.update(_structure_settings(settings.primitive))
    return found


def _filter_width(render, warn):
    """Return the pixel filter's width in pixels, to each side."""
    if render.filter_size > _WIDEST_FILTER:
        warn(f'A pixel filter of {render.filter_size:g} pixels is too wide; {_WIDEST_FILTER:g} is used '
             'instead.')
    return min(max(render.filter_size, 0.01), _WIDEST_FILTER)


def build(depsgraph, size, samples, view, projection, passes, warn, camera=None, viewport=False,
          by_paths=True):
    """Return a request for a dependency graph's scene.

    `size` is (width, height) in pixels, `samples` (first, last exclusive), `view` world to camera
    and `projection` camera to clip space, both 4x4 matrices; `passes` are names. `camera` is the
    evaluated camera through whose lens the picture is seen, or None: then everything is sharp. Without
    `by_paths` Real-time knows all that is asked for.
    """
    width, height = size
    if width < 1 or height < 1:
        raise BadRequest(f'The picture has no pixels ({width}x{height}); raise the resolution or '
                         'its percentage in the Output properties.')
    view, projection = np.array(view, np.float64), np.array(projection, np.float64)
    if not (np.isfinite(view).all() and np.isfinite(projection).all()):
        raise BadRequest("The camera's place or lens is not a number; clear its transform or choose "
                         'another camera.')
    scene = depsgraph.scene
    used = method(scene.panoptes, viewport) if by_paths else 'realtime'
    settings = _settings(depsgraph, used, viewport, warn)
    if 'debug_picture' in settings:
        # It looks through the pixels' centres: another sample would be the same.
        samples = (0, 1)
    return {
        'width': width,
        'height': height,
        'samples': samples,
        'seed': scene.panoptes.seed,
        'view': view,
        'projection': projection,
        'passes': list(passes),
        'method': used,
        'lens': {} if camera is None else _lens(camera, scene.panoptes, used, warn),
        'filter_width': _filter_width(scene.render, warn),
        'exposure': scene.panoptes.exposure,
        'force_all_effects': scene.panoptes.force_all_effects,
        'settings': settings,
    }


def _lens(camera, settings, used, warn):
    """Return the `lens` of a request; {} where everything is sharp."""
    if not lens.is_used(camera) or debug_pictures.shows_technique(settings):
        return {}
    if used == 'realtime' or settings.primitive.primary == 'RASTERISED':
        warn(f"Camera '{camera.name}' has depth of field, which rasterised pictures do not show; everything is "
             'sharp instead. Choose Primitive Tracing and traced camera rays to see it.')
        return {}
    return lens.of(camera, warn)


def _region(render, width, height):
    """Return the render region (left, bottom, right, top) in pixels, as Blender rounds it."""
    if not render.use_border:
        return 0, 0, width, height
    return (int(render.border_min_x * width), int(render.border_min_y * height),
            int(render.border_max_x * width), int(render.border_max_y * height))


def _cropped(projection, region, width, height):
    """Return a projection that fills the picture with `region` of a width x height frame."""
    left, bottom, right, top = region
    if region == (0, 0, width, height) or right <= left or top <= bottom:
        return projection
    scale_x, scale_y = width / (right - left), height / (top - bottom)
    crop = np.eye(4)
    crop[0, 0], crop[1, 1] = scale_x, scale_y
    crop[0, 3] = scale_x - 1.0 - 2.0 * left / (right - left)
    crop[1, 3] = scale_y - 1.0 - 2.0 * bottom / (top - bottom)
    return crop @ projection


def _active_camera(depsgraph):
    scene = depsgraph.scene
    if scene.camera is None:
        raise BadRequest(f"Scene '{scene.name}' has no camera; add one and make it the active "
                         'camera.')
    return scene.camera.evaluated_get(depsgraph)


def preview(depsgraph):
    """Return the request of a preview.

    It has few samples, small shadow maps and nothing that is gathered from around, and takes no longer
    than a second.
    """
    width, height = cameras.frame(depsgraph.scene.render)
    view, projection = cameras.matrices(depsgraph, _active_camera(depsgraph), width, height)
    request = build(depsgraph, (width, height), (0, _PREVIEW_SAMPLES), view, projection,
                    ['Combined'], lambda sentence: None)
    request['settings'].pop('denoise', None)
    request['settings'].update(time_budget=1.0, shadow_resolution=256, occlusion={'strength': 0.0},
                               cache={'enabled': False}, specular_rays={'mode': 'off'})
    return request


def final(depsgraph, passes, warn, part=False):
    """Return the request of a final render of a dependency graph's scene.

    Its size is that of the render region, where one is set. `part` says that its samples are put
    together with others'.
    """
    scene, camera = depsgraph.scene, _active_camera(depsgraph)
    render = scene.render
    width, height = cameras.frame(render)
    if cameras.is_panoramic(camera):
        warn(f"Camera '{camera.name}' is panoramic, which is not supported yet; a perspective view "
             'is used instead.')
    if render.use_multiview:
        warn('Stereoscopy is not supported yet; the view of the camera itself is rendered.')
    region = _region(render, width, height)
    view, projection = cameras.matrices(depsgraph, camera, width, height)
    settings = scene.panoptes
    samples = (settings.first_sample, settings.first_sample + settings.samples)
    request = build(depsgraph, (region[2] - region[0], region[3] - region[1]), samples, view,
                    _cropped(projection, region, width, height), passes, warn, camera)
    if part and request['settings'].pop('denoise', None):
        warn(denoising.MERGED)
    # Samples of a part must look as they do in the whole, of which nothing is known.
    few = samples[0] == 0 and samples[1] < _LAMP_POINTS and not part
    if settings.realtime.penumbrae == 'AUTO' and few:
        request['settings']['filter_penumbrae'] = True
    return request


def _looked_through(depsgraph, space, region_data):
    """Return the evaluated camera that a 3D View looks through, or None."""
    if region_data.view_perspective != 'CAMERA':
        return None
    camera = space.camera if space.use_local_camera else depsgraph.scene.camera
    return None if camera is None else camera.evaluated_get(depsgraph)


def _camera_frame(scene, space, region, region_data):
    """Return the camera's frame (left, bottom, right, top) in a region's pixels, or None."""
    camera = space.camera if space.use_local_camera else scene.camera
    if camera is None or camera.type != 'CAMERA':
        return None
    corners = np.array([(*corner, 1.0) for corner in camera.data.view_frame(scene=scene)])
    placed = corners @ np.array(region_data.perspective_matrix
                                @ camera.matrix_world.normalized(), np.float64).T
    if not (np.isfinite(placed).all() and (placed[:, 3] > 0.0).all()):
        return None
    places = (placed[:, :2] / placed[:, 3:] * 0.5 + 0.5) * (region.width, region.height)
    return (*places.min(axis=0), *places.max(axis=0))


def _view_rectangle(scene, space, region, region_data):
    """Return the part (left, bottom, right, top) of a 3D View's region that is rendered, in pixels."""
    whole = (0, 0, region.width, region.height)
    if region_data.view_perspective == 'CAMERA':
        border, prefix, used = scene.render, 'border', scene.render.use_border
        frame = _camera_frame(scene, space, region, region_data) if used else None
    else:
        border, prefix, used = space, 'render_border', space.use_render_border
        frame = whole
    if not used or frame is None:
        return whole
    found = []
    for side in ('min', 'max'):
        for axis in (0, 1):
            part = getattr(border, f'{prefix}_{side}_{"xy"[axis]}')
            place = frame[axis] + part * (frame[axis + 2] - frame[axis])
            found.append(int(min(max(round(place), 0), whole[axis + 2])))
    left, bottom, right, top = found
    # Where the border lies outside the region, or between two pixels, there is nothing to see.
    return (left, bottom, right, top) if left < right and bottom < top else whole


def viewport(depsgraph, region, region_data, space, pixel, warn, shown=view_shading.COMBINED):
    """Return (request, (left, bottom, width, height)) of a 3D View: the place is in the region's pixels.

    One pixel of the picture covers `pixel` x `pixel` of the region; `shown` is the `ViewPass` that it shows.
    """
    scene = depsgraph.scene
    rectangle = left, bottom, right, top = _view_rectangle(scene, space, region, region_data)
    size = (max((right - left) // pixel, 1), max((top - bottom) // pixel, 1))
    projection = _cropped(np.array(region_data.window_matrix, np.float64), rectangle, region.width,
                          region.height)
    request = build(depsgraph, size, (0, scene.panoptes.viewport_samples), region_data.view_matrix,
                    projection, list(dict.fromkeys(('Combined', shown.name))), warn,
                    _looked_through(depsgraph, space, region_data), viewport=True, by_paths=shown.by_paths)
    if shown is not view_shading.COMBINED:
        request['shown_pass'] = shown.name
    # The picture is shown while it refines.
    request['live'] = True
    # It comes after others like it, whose light it may keep.
    request['viewport'] = True
    request['settings']['filter_penumbrae'] = scene.panoptes.realtime.penumbrae != 'SAMPLED'
    if request['method'] != 'realtime':
        # Paths take over a picture that Real-time begins.
        request['settings'].update(_realtime_settings(depsgraph, warn))
    # Limits are for final renders; a view goes on until it has its samples.
    for limit in ('time_budget', 'noise_threshold'):
        request['settings'].pop(limit, None)
    return request, (left, bottom, right - left, top - bottom)


def coarser(request, coarseness):
    """Return a 3D View's request whose pixels cover so many by so many of `request`'s."""
    if coarseness == 1:
        return request
    size = {name: max(-(-request[name] // coarseness), 1) for name in ('width', 'height')}
    return {**request, **size}
