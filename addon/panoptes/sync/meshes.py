# SPDX-License-Identifier: GPL-3.0-or-later
"""Evaluated objects -> plain arrays of triangles.

Everything is read in bulk, and nothing points into Blender's memory afterwards. On 3.4 the index
arrays are copied straight from memory (see `memory`), since `foreach_get` is ten times slower there.
"""

from typing import NamedTuple

import numpy as np

from .. import compat
from . import memory

class MeshArrays(NamedTuple):
    """One mesh: V vertices, T triangles, L loops (face corners); object space, metres."""

    name: str
    positions: np.ndarray          # float32[V, 3]
    triangle_vertices: np.ndarray  # int32[T, 3]
    triangle_loops: np.ndarray     # int32[T, 3]
    triangle_slots: np.ndarray     # int32[T], material slot, not clamped
    loop_normals: np.ndarray       # float32[L, 3]
    attributes: dict               # name -> float32[L, 2] (UV) or float32[L, 4] (linear colour)
    default_uv: str
    default_color: str


def extract(thing, warn):
    """Return the `MeshArrays` of an evaluated object of type MESH, or None without any triangle.

    `warn` takes a sentence; it is called when the object had to be repaired.
    """
    # Evaluated data can be read as it is, but in edit mode it is a wrapper without arrays.
    mesh = thing.data
    if not mesh.is_editmode:
        return _read(mesh, thing.name, warn)
    mesh = thing.to_mesh()
    try:
        return _read(mesh, thing.name, warn)
    finally:
        thing.to_mesh_clear()


def _read(mesh, name, warn):
    mesh.calc_loop_triangles()
    count = len(mesh.loop_triangles)
    if count == 0:
        return None
    vertices, loops = len(mesh.vertices), len(mesh.loops)
    positions = np.empty((vertices, 3), np.float32)
    mesh.vertices.foreach_get('co', positions.reshape(-1))

    fast = memory.read_topology(mesh)
    if fast is not None:
        loop_vertices, triangle_loops, triangle_polygons = fast
    else:
        loop_vertices = compat.loop_vertices(mesh)
        triangle_loops = np.empty((count, 3), np.int32)
        mesh.loop_triangles.foreach_get('loops', triangle_loops.reshape(-1))
        triangle_polygons = np.empty(count, np.int32)
        mesh.loop_triangles.foreach_get('polygon_index', triangle_polygons)
    triangle_vertices = loop_vertices[triangle_loops]

    normals = compat.loop_normals(mesh)
    attributes = _attributes(mesh, loops, loop_vertices)
    slots = _polygon_slots(mesh)[triangle_polygons]

    positions, keep = _repair(positions, triangle_vertices, name, warn)
    if keep is not None:
        if not keep.any():
            return None
        triangle_vertices, triangle_loops, slots = (
            triangle_vertices[keep], triangle_loops[keep], slots[keep])
    for array in (normals, *attributes.values()):
        if not np.isfinite(array).all():
            np.nan_to_num(array, copy=False, posinf=0.0, neginf=0.0)

    uv = next((layer.name for layer in mesh.uv_layers if layer.active_render), '')
    return MeshArrays(name, positions, np.ascontiguousarray(triangle_vertices),
                      np.ascontiguousarray(triangle_loops), np.ascontiguousarray(slots), normals,
                      attributes, uv, compat.default_color_name(mesh))


def _polygon_slots(mesh):
    """Return the material slot of each polygon, int32."""
    slots = np.zeros(len(mesh.polygons), np.int32)
    attribute = mesh.attributes.get('material_index')
    if attribute is not None and attribute.domain == 'FACE' and attribute.data_type == 'INT':
        attribute.data.foreach_get('value', slots)
    elif len(mesh.materials) > 1 and attribute is not None:
        mesh.polygons.foreach_get('material_index', slots)
    return slots


def _attributes(mesh, loops, loop_vertices):
    """Return UV maps and colour attributes by name, one row a loop."""
    attributes = {layer.name: compat.uv_coordinates(layer, loops) for layer in mesh.uv_layers}
    for color in mesh.color_attributes:
        if color.name in attributes or color.domain not in ('POINT', 'CORNER'):
            continue
        values = np.empty((len(color.data), 4), np.float32)
        color.data.foreach_get('color', values.reshape(-1))
        attributes[color.name] = values if color.domain == 'CORNER' else values[loop_vertices]
    return attributes


def _repair(positions, triangle_vertices, name, warn):
    """Return (positions, mask of triangles to keep or None for all), warning of bad vertices."""
    if np.isfinite(positions).all():
        return positions, None
    bad = ~np.isfinite(positions).all(axis=1)
    warn(f"Object '{name}' has {int(bad.sum())} vertices whose coordinates are not numbers; their "
         'faces are left out. Delete those vertices or the modifier that makes them.')
    positions = np.where(bad[:, None], np.float32(0.0), positions)
    return positions, ~bad[triangle_vertices].any(axis=1)
