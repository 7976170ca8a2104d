# SPDX-License-Identifier: GPL-3.0-or-later
"""From scenes and views to the request dictionaries of the native engine."""

import numpy as np

_METHOD_NAMES = {'fragment': 'Fragment tracing', 'primitive': 'Primitive tracing'}


class BadRequest(RuntimeError):
    """The scene asks for something that cannot be rendered; the text says what and the remedy."""


def method(settings, warn):
    """Return the method to use; a method that does not work yet is replaced, with a warning."""
    if settings.method in _METHOD_NAMES:
        warn(f'{_METHOD_NAMES[settings.method]} does not work yet; Real-time is used instead.')
    return 'realtime'


def _inverted(matrix):
    """Return the inverse of a matrix in double precision, or the matrix where there is none.

    Blender's own inverse is in single precision: a camera at 1000 km would be off by centimetres.
    """
    matrix = np.array(matrix, np.float64)
    try:
        return np.linalg.inv(matrix)
    except np.linalg.LinAlgError:
        return matrix


def _settings(scene):
    settings = scene.panoptes
    found = {
        'shadow_resolution': settings.realtime.shadow_resolution,
        'soft_shadows': settings.realtime.soft_shadows,
        'bounces': settings.bounces,
        'film_transparent': scene.render.film_transparent,
    }
    # 0 switches a limit off.
    if settings.time_budget > 0.0:
        found['time_budget'] = settings.time_budget
    if settings.noise_threshold > 0.0:
        found['noise_threshold'] = settings.noise_threshold
    return found


def build(scene, size, samples, view, projection, passes, warn):
    """Return a request.

    `size` is (width, height) in pixels, `samples` (first, last exclusive), `view` world to camera
    and `projection` camera to clip space, both 4x4 matrices; `passes` are names.
    """
    width, height = size
    if width < 1 or height < 1:
        raise BadRequest(f'The picture has no pixels ({width}x{height}); raise the resolution or '
                         'its percentage in the Output properties.')
    view, projection = np.array(view, np.float64), np.array(projection, np.float64)
    if not (np.isfinite(view).all() and np.isfinite(projection).all()):
        raise BadRequest("The camera's place or lens is not a number; clear its transform or choose "
                         'another camera.')
    return {
        'width': width,
        'height': height,
        'samples': samples,
        'seed': scene.panoptes.seed,
        'view': view,
        'projection': projection,
        'passes': list(passes),
        'method': method(scene.panoptes, warn),
        'filter_width': max(scene.render.filter_size, 0.01),
        'exposure': scene.panoptes.exposure,
        'force_all_effects': scene.panoptes.force_all_effects,
        'settings': _settings(scene),
    }


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


def final(depsgraph, passes, warn):
    """Return the request of a final render of a dependency graph's scene.

    Its size is that of the render region, where one is set.
    """
    scene = depsgraph.scene
    render, camera = scene.render, scene.camera
    if camera is None:
        raise BadRequest(f"Scene '{scene.name}' has no camera; add one and make it the active "
                         'camera.')
    camera = camera.evaluated_get(depsgraph)
    width = render.resolution_x * render.resolution_percentage // 100
    height = render.resolution_y * render.resolution_percentage // 100
    if camera.type == 'CAMERA' and camera.data.type == 'PANO':
        warn(f"Camera '{camera.name}' is panoramic, which is not supported yet; a perspective view "
             'is used instead.')
    if camera.type == 'CAMERA' and camera.data.dof.use_dof:
        warn(f"Camera '{camera.name}' has depth of field, which is not supported yet; everything is "
             'sharp.')
    if render.use_multiview:
        warn('Stereoscopy is not supported yet; the view of the camera itself is rendered.')
    region = _region(render, width, height)
    projection = np.array(camera.calc_matrix_camera(
        depsgraph, x=max(width, 1), y=max(height, 1), scale_x=render.pixel_aspect_x,
        scale_y=render.pixel_aspect_y))
    # A camera's scale never changes the picture.
    view = _inverted(camera.matrix_world.normalized())
    settings = scene.panoptes
    samples = (settings.first_sample, settings.first_sample + settings.samples)
    return build(scene, (region[2] - region[0], region[3] - region[1]), samples, view,
                 _cropped(projection, region, width, height), passes, warn)


def viewport(scene, size, region_data, warn):
    """Return the request of a 3D View of `size` pixels."""
    samples = (0, scene.panoptes.viewport_samples)
    request = build(scene, size, samples, region_data.view_matrix, region_data.window_matrix,
                    ['Combined'], warn)
    # The picture is shown while it refines.
    request['live'] = True
    # Limits are for final renders; a view goes on until it has its samples.
    for limit in ('time_budget', 'noise_threshold'):
        request['settings'].pop(limit, None)
    return request
