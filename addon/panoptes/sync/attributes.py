# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes of meshes beside UV maps: which there are, and their values a loop.

All of them reach a material as four channels, as Cycles' Attribute node shows them: a number is
grey, a vector is a colour, both opaque.
"""

import numpy as np

# The field and the type that foreach_get reads, and how many numbers an element has.
_FIELDS = {
    'FLOAT': ('value', np.float32, 1),
    'INT': ('value', np.int32, 1),
    'INT8': ('value', np.int32, 1),
    'BOOLEAN': ('value', bool, 1),
    'FLOAT2': ('vector', np.float32, 2),
    'FLOAT_VECTOR': ('vector', np.float32, 3),
    'FLOAT_COLOR': ('color', np.float32, 4),
    'BYTE_COLOR': ('color', np.float32, 4),
}
# Cycles shows none of edges either.
_DOMAINS = ('POINT', 'CORNER', 'FACE')


def colors(mesh):
    """Return the names of colour attributes of points and corners that are no UV map's too."""
    taken = {layer.name for layer in mesh.uv_layers}
    return [a.name for a in mesh.color_attributes
            if a.name not in taken and a.domain in ('POINT', 'CORNER') and len(a.data)]


def others(mesh):
    """Return the names of every other attribute that a material can read."""
    taken = {layer.name for layer in mesh.uv_layers}.union(colors(mesh))
    return [a.name for a in mesh.attributes
            if a.name not in taken and a.data_type in _FIELDS and a.domain in _DOMAINS
            and len(a.data)]


def undeformed(mesh):
    """Return positions before modifiers and shape keys, float32[V, 3], or None where they are the
    same. Blender keeps them for final renders only."""
    places = np.empty((2, len(mesh.vertices), 3), np.float32)
    mesh.vertices.foreach_get('co', places[0].reshape(-1))
    mesh.vertices.foreach_get('undeformed_co', places[1].reshape(-1))
    # They went through the texture space and back, each at the precision of floats.
    tolerance = 1e-5 * max(map(abs, (*mesh.texspace_location, *mesh.texspace_size)))
    # What is not a number differs from nothing.
    return places[1] if (np.abs(places[0] - places[1]) > tolerance).any() else None


def opaque(vectors):
    """Return float32[N, 3] as four channels."""
    return np.concatenate((vectors, np.ones((len(vectors), 1), np.float32)), axis=1)


def read(mesh, name, loop_vertices):
    """Return an attribute's values, float32[L, 4], one row a loop (linear colour)."""
    attribute = mesh.attributes[name]
    field, kind, channels = _FIELDS[attribute.data_type]
    found = np.empty((len(attribute.data), channels), kind)
    attribute.data.foreach_get(field, found.reshape(-1))
    if channels == 4:
        values = found
    else:
        values = np.zeros((len(found), 4), np.float32)
        values[:, 3] = 1.0
        values[:, :3 if channels == 1 else channels] = found
    if attribute.domain == 'POINT':
        return values[loop_vertices]
    if attribute.domain == 'FACE':
        totals = np.empty(len(mesh.polygons), np.int32)
        mesh.polygons.foreach_get('loop_total', totals)
        return np.repeat(values, totals, axis=0)
    return values
