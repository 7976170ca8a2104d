# SPDX-License-Identifier: GPL-3.0-or-later
"""Evaluated objects -> triangles ready for the native engine.

On 3.4 the native module reads Blender's arrays where they lie (see `memory`); else everything is
read in bulk into plain arrays. Nothing points into Blender's memory afterwards, and both ways give
the same bits.
"""

import zlib
from typing import NamedTuple, Optional

import numpy as np

from .. import compat
from ..nodes import UNDEFORMED
from . import attributes, memory


class MeshArrays(NamedTuple):
    """One mesh as the native `set_mesh` takes it; object space, metres.

    V vertices, T triangles, L loops (face corners).
    """

    name: str
    positions: np.ndarray          # float32[V, 3]
    triangle_vertices: np.ndarray  # int32[T, 3]
    triangle_loops: np.ndarray     # int32[T, 3]
    triangle_slots: np.ndarray     # int32[T], material slot
    loop_normals: np.ndarray       # float32[L, 3]
    attributes: dict               # name -> float32[L, 2] (UV) or float32[L, 4] (linear colour)
    default_uv: str
    default_color: str
    texture_space: tuple           # (low, high) corner of what generated coordinates map to 0..1

    @property
    def fingerprint(self):
        """What tells this mesh from another: names, shapes and checksums."""
        named = sorted(self.attributes.items())
        arrays = (*self[1:6], *(array for _, array in named))
        return (self.default_uv, self.default_color, self.texture_space, tuple(name for name, _ in named),
                tuple((a.shape, zlib.crc32(np.ascontiguousarray(a).reshape(-1).view(np.uint8)))
                      for a in arrays))

    def arguments(self):
        """The arguments of `set_mesh` after the id."""
        return tuple(self)


class NativeMesh(NamedTuple):
    """One mesh that the native module read; the first engine that gets it takes it over."""

    mesh: object

    @property
    def fingerprint(self):
        """What tells this mesh from another."""
        return self.mesh.fingerprint

    def arguments(self):
        """The arguments of `set_mesh` after the id."""
        return (self.mesh,)


class Extracted(NamedTuple):
    """What an object holds: a mesh (None without any triangle), and its attributes beside UV maps
    and colours: `available` names, of which `delivered` are in the mesh.

    Undeformed positions count as delivered, too, where nothing deforms the mesh.
    """

    mesh: Optional[NamedTuple]
    available: frozenset
    delivered: frozenset


def extract(thing, slots, wanted, warn, final=False):
    """Return the `Extracted` mesh of an evaluated object of type MESH.

    `slots` is its number of material slots: faces may name more, and Blender then uses the last.
    `wanted` are the names of attributes that its materials read. `warn` takes a sentence; it is
    called when the object had to be repaired. `final` says that Blender evaluated for a final
    render, so that it kept where vertices were before modifiers.
    """
    # Metaballs cannot have shape keys.
    shapes = getattr(thing.original.data, 'shape_keys', None)
    moved = final and (len(thing.modifiers) or shapes is not None)
    own = {UNDEFORMED} if moved else set()
    # Evaluated data can be read as it is, but in edit mode it is a wrapper without arrays.
    mesh = thing.data
    if not mesh.is_editmode:
        return _extract(mesh, thing.name, slots, wanted, own, warn)
    mesh = thing.to_mesh()
    try:
        return _extract(mesh, thing.name, slots, wanted, own, warn)
    finally:
        thing.to_mesh_clear()


def _extract(mesh, name, slots, wanted, own, warn):
    mesh.calc_loop_triangles()
    available = frozenset(attributes.others(mesh)) | own
    delivered = available & frozenset(wanted)
    found = None
    if len(mesh.loop_triangles):
        # Names: calc_normals_split() moves the attributes themselves.
        chosen = attributes.colors(mesh) + sorted(delivered - own)
        moved = attributes.undeformed(mesh) if delivered & own else None
        found = (_read_memory(mesh, name, slots, chosen, moved, warn)
                 or _read_arrays(mesh, name, slots, chosen, moved, warn))
    return Extracted(found if found and _triangles(found) else None, available, delivered)


def _triangles(found):
    return (found.mesh.triangles if isinstance(found, NativeMesh) else len(found.triangle_vertices))


def _default_uv(mesh):
    return next((layer.name for layer in mesh.uv_layers if layer.active_render), '')


def _texture_space(mesh):
    """Return the corners of a mesh's texture space: the undeformed mesh, unless the artist moved it."""
    pairs = tuple(zip(mesh.texspace_location, mesh.texspace_size))
    if not np.isfinite(pairs).all():
        return None
    return (tuple(place - abs(size) for place, size in pairs),
            tuple(place + abs(size) for place, size in pairs))


def _warn_broken(count, name, warn):
    if count:
        warn(f"Object '{name}' has {count} vertices whose coordinates are not numbers; their "
             'faces are left out. Delete those vertices or the modifier that makes them.')


def _read_memory(mesh, name, slots, chosen, moved, warn):
    points = {} if moved is None else {UNDEFORMED: moved}
    found = memory.read(mesh, name, slots, chosen, points, default_uv=_default_uv(mesh),
                        default_color=compat.default_color_name(mesh),
                        texture_space=_texture_space(mesh))
    if found is None:
        return None
    _warn_broken(found.broken_vertices, name, warn)
    return NativeMesh(found)


def _read_arrays(mesh, name, slots, chosen, moved, warn):
    triangles, loops = len(mesh.loop_triangles), len(mesh.loops)
    positions = np.empty((len(mesh.vertices), 3), np.float32)
    mesh.vertices.foreach_get('co', positions.reshape(-1))
    loop_vertices = compat.loop_vertices(mesh)
    triangle_loops = np.empty((triangles, 3), np.int32)
    mesh.loop_triangles.foreach_get('loops', triangle_loops.reshape(-1))
    triangle_polygons = np.empty(triangles, np.int32)
    mesh.loop_triangles.foreach_get('polygon_index', triangle_polygons)
    triangle_vertices = loop_vertices[triangle_loops]
    triangle_slots = np.clip(_polygon_slots(mesh), 0, slots - 1)[triangle_polygons]
    normals = compat.loop_normals(mesh)
    values = {layer.name: compat.uv_coordinates(layer, loops) for layer in mesh.uv_layers}
    values.update((key, attributes.read(mesh, key, loop_vertices)) for key in chosen)
    if moved is not None:
        values[UNDEFORMED] = attributes.opaque(moved)[loop_vertices]

    positions, keep = _repair(positions, triangle_vertices, name, warn)
    if keep is not None:
        triangle_vertices, triangle_loops, triangle_slots = (
            triangle_vertices[keep], triangle_loops[keep], triangle_slots[keep])
    for array in (normals, *values.values()):
        if not np.isfinite(array).all():
            np.nan_to_num(array, copy=False, posinf=0.0, neginf=0.0)
    return MeshArrays(name, positions, np.ascontiguousarray(triangle_vertices),
                      np.ascontiguousarray(triangle_loops), np.ascontiguousarray(triangle_slots),
                      normals, values, _default_uv(mesh), compat.default_color_name(mesh),
                      _texture_space(mesh))


def _polygon_slots(mesh):
    """Return the material slot of each polygon, int32."""
    slots = np.zeros(len(mesh.polygons), np.int32)
    attribute = mesh.attributes.get('material_index')
    if attribute is not None and attribute.domain == 'FACE' and attribute.data_type == 'INT':
        attribute.data.foreach_get('value', slots)
    elif len(mesh.materials) > 1 and attribute is not None:
        mesh.polygons.foreach_get('material_index', slots)
    return slots


def _repair(positions, triangle_vertices, name, warn):
    """Return (positions, mask of triangles to keep or None for all), warning of bad vertices."""
    bad = ~np.isfinite(positions).all(axis=1)
    if not bad.any():
        return positions, None
    _warn_broken(int(bad.sum()), name, warn)
    positions = np.where(bad[:, None], np.float32(0.0), positions)
    return positions, ~bad[triangle_vertices].any(axis=1)
