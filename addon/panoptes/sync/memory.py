# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes straight from Blender 3.4's memory, read by the native module.

Blender 3.4 keeps a mesh in arrays of structs whose elements `foreach_get` visits one by one through
a getter, for half a second on a million triangles. Their layout is known for that version. What is
passed on was checked: the distance between elements of each array, and its last element against
what Blender says of it. The native module copies before it returns. On any doubt the answer is
None, and the caller uses `foreach_get`.
"""

import ctypes

from .. import compat, native

# Bytes between the elements of each array.
_SIZES = {'vertex': 16, 'loop': 8, 'polygon': 12, 'triangle': 16, 'UV': 12, 'normal': 12,
          'FLOAT': 4, 'INT': 4, 'INT8': 1, 'BOOLEAN': 1, 'FLOAT_VECTOR': 12, 'FLOAT2': 8,
          'FLOAT_COLOR': 16, 'BYTE_COLOR': 4}


class _Unknown(Exception):
    """The memory does not look as it should."""


def _array(collection, kind):
    """Return (address, length) of the array behind a collection that is not empty."""
    count, size = len(collection), _SIZES[kind]
    if count == 0:
        raise _Unknown
    first = collection[0].as_pointer()
    # The last element as well as the second: a collection that were scattered would not fit both.
    if (count > 1 and collection[1].as_pointer() - first != size) or (
            collection[count - 1].as_pointer() - first != size * (count - 1)):
        raise _Unknown
    return first, count


def _compare(address, c_type, values):
    """Make sure that the numbers at an address have the same bits as these."""
    found = (c_type * len(values)).from_address(address)
    if bytes(found) != bytes((c_type * len(values))(*values)):
        raise _Unknown


def _topology(mesh):
    """Return the blocks of vertices, loops, polygons and triangles, each with its last one checked."""
    blocks = {name: _array(collection, kind) for name, collection, kind in (
        ('vertices', mesh.vertices, 'vertex'), ('loops', mesh.loops, 'loop'),
        ('polygons', mesh.polygons, 'polygon'), ('triangles', mesh.loop_triangles, 'triangle'))}

    def last(name, kind):
        address, count = blocks[name]
        return address + (count - 1) * _SIZES[kind]

    _compare(last('vertices', 'vertex'), ctypes.c_float, tuple(mesh.vertices[-1].co))
    loop, polygon, triangle = mesh.loops[-1], mesh.polygons[-1], mesh.loop_triangles[-1]
    _compare(last('loops', 'loop'), ctypes.c_uint32, (loop.vertex_index, loop.edge_index))
    _compare(last('polygons', 'polygon'), ctypes.c_int32, (polygon.loop_start, polygon.loop_total))
    smooth = ctypes.c_uint8.from_address(last('polygons', 'polygon') + 10).value & 1
    if bool(smooth) != polygon.use_smooth:
        raise _Unknown
    _compare(last('triangles', 'triangle'), ctypes.c_uint32,
             (*triangle.loops, triangle.polygon_index))
    return blocks


def _normals(module, mesh, loops):
    """Return the addresses of split normals, or of those of vertices and polygons.

    Without auto smooth Blender has nothing to split: smooth polygons use their vertices' normals,
    flat ones their own.
    """
    if not mesh.use_auto_smooth:
        return {'loop_normals': 0, 'vertex_normals': _array(mesh.vertex_normals, 'normal')[0],
                'polygon_normals': _array(mesh.polygon_normals, 'normal')[0]}
    # Evaluating an object leaves its split normals there; what nodes make comes without.
    address = module.find_loop_normals(mesh.as_pointer(), *loops)
    if not address:
        mesh.calc_normals_split()
        address = module.find_loop_normals(mesh.as_pointer(), *loops)
        if not address:
            raise _Unknown
    for index in (0, len(mesh.loops) - 1):
        _compare(address + 12 * index, ctypes.c_float, tuple(mesh.loops[index].normal))
    return {'loop_normals': address, 'vertex_normals': 0, 'polygon_normals': 0}


def _slots(mesh):
    """Return the address of the polygons' material slots, or 0 where all are the first."""
    attribute = mesh.attributes.get('material_index')
    if attribute is None:
        return 0
    if attribute.domain != 'FACE' or attribute.data_type != 'INT':
        raise _Unknown
    return _array(attribute.data, 'INT')[0]


def read(mesh, name, slots, attributes, points, **named):
    """Return the native Mesh of a mesh whose loop triangles are there, or None.

    `slots` is the number of material slots; `attributes` names the colour and other attributes that
    are wanted beside the UV maps, `points` holds further ones as float32[V, 3]. `named` are those of `MeshArrays` that are no arrays.
    """
    if not (3, 4, 0) <= compat.VERSION < (3, 5, 0):
        return None
    try:
        module = native.module()
        blocks = _topology(mesh)
        found = [(layer.name, 'CORNER', 'UV', *_array(layer.data, 'UV')) for layer in mesh.uv_layers]
        for attribute in map(mesh.attributes.__getitem__, attributes):
            found.append((attribute.name, attribute.domain, attribute.data_type,
                          *_array(attribute.data, attribute.data_type)))
        found += [(key, 'POINT', 'FLOAT_VECTOR', values.ctypes.data, len(values))
                  for key, values in points.items()]
        return module.read_mesh(
            name=name, **blocks, **_normals(module, mesh, blocks['loops']), slots=_slots(mesh),
            slot_count=slots, attributes=found, **named)
    except (_Unknown, native.Unavailable):
        return None
