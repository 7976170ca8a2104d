# SPDX-License-Identifier: GPL-3.0-or-later
"""From a scene's settings to the `cache` of a request: indirect light in Real-time."""

import numpy as np

from . import debug_pictures, indirect_scale
from .wording import listed

# Of the native engine.
_FEWEST_CELLS = 4
_MOST_REGIONS = 8
# A box whose volume is less than this share of that of a cuboid with the same edges is flat.
_FLAT = 1e-6


def settings(depsgraph, warn):
    """Return the `cache` of a request for a dependency graph's scene; `warn` takes sentences."""
    scene = depsgraph.scene
    ours = scene.panoptes.radiance_cache
    return {
        'enabled': ours.enabled,
        'bounces': min(ours.bounces, scene.panoptes.bounces),
        'resolution': _resolution(ours.resolution, warn),
        'voxels': ours.voxels,
        'cascades': ours.cascades,
        'encoding': ours.encoding.lower(),
        'luminance': ours.luminance,
        'chrominance': ours.chrominance,
        'regions': _regions(depsgraph, ours.region_collection, warn),
        'first_bounce': ours.first_bounce.lower(),
        'directions': ours.directions,
        'march_steps': ours.march_steps,
        'voxel_fill': ours.voxel_fill,
        'occupancy': ours.occupancy.lower(),
        'depth_stride': ours.depth_stride,
        'dilate': ours.dilate,
        'rsm_samples': ours.rsm_samples,
        'rsm_resolution': ours.rsm_resolution,
        'rsm_spread': ours.rsm_spread,
        'rsm_mixed': ours.rsm_mixed,
        'blend': ours.blend,
        'rebuild_every': ours.rebuild_every,
        'picture': debug_pictures.of_technique(scene.panoptes, debug_pictures.CACHE),
    }


def _resolution(cells, warn):
    """Return a number of cells that there can be; 0 chooses it."""
    if 0 < cells < _FEWEST_CELLS:
        warn(f'{cells} cells are too few for indirect light; {_FEWEST_CELLS} are used instead. Set its Resolution '
             f'to {_FEWEST_CELLS} or more, or to 0.')
        return _FEWEST_CELLS
    return cells


def _regions(depsgraph, collection, warn):
    """Return the boxes of a collection's objects, by name: [{'world_to_box': 4x4, 'luminance', 'chrominance'}].

    A box is [-1, 1]^3. The matrices are lists, which can be compared and stored.
    """
    if collection is None:
        return []
    things = sorted(collection.all_objects, key=lambda thing: thing.name_full)
    others = [thing.name for thing in things if not _is_box(thing)]
    if others:
        warn(f"In collection '{collection.name}', {listed(others)} cannot bound a region; keep only meshes and empties "
             'that are displayed as cubes in the collection of regions.')
    found = []
    for thing in filter(_is_box, things):
        if len(found) == _MOST_REGIONS:
            warn(f"Collection '{collection.name}' has more than {_MOST_REGIONS} regions; the first by name are used. "
                 'Take the others out of it.')
            break
        thing = thing.original.evaluated_get(depsgraph)
        world_to_box = _world_to_box(thing, warn)
        if world_to_box is not None:
            luminance, chrominance = indirect_scale.of_object(thing, warn)
            found.append({'world_to_box': world_to_box.tolist(), 'luminance': luminance, 'chrominance': chrominance})
    return found


def _is_box(thing):
    return thing.type == 'MESH' or (thing.type == 'EMPTY' and thing.empty_display_type == 'CUBE')


def _world_to_box(thing, warn):
    """Return the matrix from the world to the box of an evaluated object, or None where it has none."""
    if thing.type == 'EMPTY':
        low, high = np.full(3, -thing.empty_display_size), np.full(3, thing.empty_display_size)
    else:
        corners = np.array(thing.bound_box, np.float64)
        low, high = corners.min(axis=0), corners.max(axis=0)
    local = np.eye(4)
    local[:3, :3] = np.diag((high - low) / 2.0)
    local[:3, 3] = (low + high) / 2.0
    box_to_world = np.array(thing.matrix_world, np.float64) @ local
    if not np.isfinite(box_to_world).all():
        warn(f"The place or size of region '{thing.name}' is not a number; it is left out. Clear its transform.")
        return None
    edges = box_to_world[:3, :3]
    if not abs(np.linalg.det(edges)) > _FLAT * np.linalg.norm(edges, axis=0).prod():
        warn(f"Region '{thing.name}' is flat and holds nothing; it is left out. Scale it so that it has a volume.")
        return None
    return np.linalg.inv(box_to_world)
