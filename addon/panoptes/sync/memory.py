# SPDX-License-Identifier: GPL-3.0-or-later
"""Mesh topology straight from Blender 3.4's memory.

Blender 3.4 keeps loops and triangles in arrays of structs whose elements `foreach_get` visits one by
one through a getter. Their layout is known for that version; it is checked at run time by the
distance of two elements, and everything is copied before this module returns. On any doubt the
answer is None, and the caller uses `foreach_get`.
"""

import ctypes

import numpy as np

from .. import compat

# Sizes in bytes: MLoop {uint v, e}, MLoopTri {uint loops[3], polygon}.
_LOOP_SIZE = 8
_TRIANGLE_SIZE = 16

_layout_known = (3, 4, 0) <= compat.VERSION < (3, 5, 0)


def _view(collection, count, size):
    """Return the array behind a collection as int32[count, size / 4] without copying, or None."""
    first = collection[0].as_pointer()
    # The last element as well as the second: a collection that were scattered would not fit both.
    if (count > 1 and collection[1].as_pointer() - first != size) or (
            collection[count - 1].as_pointer() - first != size * (count - 1)):
        return None
    data = (ctypes.c_int32 * (count * size // 4)).from_address(first)
    return np.frombuffer(data, np.int32).reshape(count, size // 4)


def read_topology(mesh):
    """Return copies (loop vertices int32[L], triangle loops int32[T, 3], triangle polygons
    int32[T]) of a mesh with at least one triangle, or None where the layout is not known."""
    if not _layout_known:
        return None
    loops, triangles = len(mesh.loops), len(mesh.loop_triangles)
    loop_view = _view(mesh.loops, loops, _LOOP_SIZE)
    triangle_view = _view(mesh.loop_triangles, triangles, _TRIANGLE_SIZE)
    if loop_view is None or triangle_view is None:
        return None
    return (loop_view[:, 0].copy(), np.ascontiguousarray(triangle_view[:, :3]),
            triangle_view[:, 3].copy())
