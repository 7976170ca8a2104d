# SPDX-License-Identifier: GPL-3.0-or-later
"""From a scene's settings to the `occlusion` of a request: multiview ambient occlusion."""

import numpy as np

from . import cameras, debug_pictures
from .wording import listed

# Of a world where no one has set another; Blender's own default.
_DEFAULT_DISTANCE = 10.0
# Metres. Nearer is within the rounding of depth maps, farther is to the end of any scene.
_LEAST_DISTANCE, _FARTHEST = 1e-6, 1e6
# The native engine looks at no more.
_MOST_CAMERAS = 4


def distance(scene):
    """Return how far occluders are looked for by either method, in metres: above 0 and finite.

    As in Cycles, the distance of the world's settings counts where the scene has none of its own, and
    0 there is to the end of the scene.
    """
    found = scene.panoptes.ambient_occlusion.distance
    if not found > 0.0:
        found = _DEFAULT_DISTANCE if scene.world is None else scene.world.light_settings.distance
    return min(max(found, _LEAST_DISTANCE), _FARTHEST) if found > 0.0 else _FARTHEST


def settings(depsgraph, warn):
    """Return the `occlusion` of a request for a dependency graph's scene; `warn` takes sentences."""
    scene = depsgraph.scene
    ours = scene.panoptes.ambient_occlusion
    return {
        'estimator': ours.estimator.lower(),
        'distance': distance(scene),
        'strength': ours.strength,
        'samples': ours.samples,
        'importance_sampling': ours.importance_sampling,
        'initial_samples': ours.initial_samples,
        'secondary_views': ours.secondary_views,
        'phantoms': ours.phantoms.lower(),
        'phantom_resolution': ours.phantom_resolution,
        'phantom_cameras': _phantom_cameras(depsgraph, ours.phantom_cameras, warn),
        'filter': ours.filter.lower(),
        'deep_shadows': ours.deep_shadows,
        'picture': debug_pictures.of_technique(scene.panoptes, debug_pictures.OCCLUSION),
    }


def _phantom_cameras(depsgraph, collection, warn):
    """Return the views of a collection's cameras, by name: [{'view': 4x4, 'projection': 4x4}].

    The matrices are lists, which can be compared and stored.
    """
    if collection is None:
        return []
    things = sorted(collection.all_objects, key=lambda thing: thing.name_full)
    others = [thing.name for thing in things if thing.type != 'CAMERA']
    if others:
        warn(f"In collection '{collection.name}', {listed(others)} cannot be looked through; keep only cameras "
             'in the collection of phantom cameras.')
    found = []
    for camera in (thing for thing in things if thing.type == 'CAMERA'):
        if len(found) == _MOST_CAMERAS:
            warn(f"Collection '{collection.name}' has more than {_MOST_CAMERAS} phantom cameras; the first by name "
                 'are used. Take the others out of it.')
            break
        view = _view(depsgraph, camera.original.evaluated_get(depsgraph), warn)
        if view is not None:
            found.append(view)
    return found


def _view(depsgraph, camera, warn):
    """Return the view of an evaluated camera, or None where it has none."""
    if cameras.is_panoramic(camera):
        warn(f"Phantom camera '{camera.name}' is panoramic, which is not supported; a perspective view is used "
             'instead.')
    view, projection = cameras.matrices(depsgraph, camera, *cameras.frame(depsgraph.scene.render))
    if not (np.isfinite(view).all() and np.isfinite(projection).all()):
        warn(f"The place or lens of phantom camera '{camera.name}' is not a number; it is left out. Clear its "
             'transform.')
        return None
    return {'view': view.tolist(), 'projection': projection.tolist()}
