# SPDX-License-Identifier: GPL-3.0-or-later
"""Lamps -> dictionaries with Blender's raw values; the native side knows their brightness."""

from .. import compat


def _node_factor(light, warn):
    """Return (r, g, b) of a lamp's node tree: its Emission node, as far as it is constant."""
    if not compat.uses_nodes(light):
        return (1.0, 1.0, 1.0)
    output = next((n for n in light.node_tree.nodes if n.type == 'OUTPUT_LIGHT'), None)
    links = output.inputs['Surface'].links if output else ()
    node = links[0].from_node if links else None
    if node is None:
        return (0.0, 0.0, 0.0)
    if node.type != 'EMISSION' or any(socket.is_linked for socket in node.inputs):
        warn(f"Light '{light.name}': nodes other than one plain Emission are not supported yet; "
             'the values of the lamp itself are used instead.')
        return (1.0, 1.0, 1.0)
    strength = node.inputs['Strength'].default_value
    return tuple(c * strength for c in tuple(node.inputs['Color'].default_value)[:3])


def describe(light, matrix, warn):
    """Return the dictionary of one lamp.

    `matrix` is object to world, float32[4, 4], row-major. Lengths are metres, angles radians, energy
    in watts (W/m2 for suns).
    """
    node = _node_factor(light, warn)
    scale = compat.light_radiance_scale(light)
    found = {
        'type': light.type,
        'matrix': matrix,
        'color': tuple(c * s * n for c, s, n in zip(light.color, scale, node)),
        'energy': light.energy,
        'radius': 0.0,
        'angle': 0.0,
        'spot_size': 0.0,
        'spot_blend': 0.0,
        'shape': 'SQUARE',
        'size': 0.0,
        'size_y': 0.0,
        'cast_shadow': compat.light_casts_shadow(light),
    }
    if light.type in ('POINT', 'SPOT'):
        found['radius'] = light.shadow_soft_size
    if light.type == 'SUN':
        found['angle'] = light.angle
    if light.type == 'SPOT':
        found['spot_size'] = light.spot_size
        found['spot_blend'] = light.spot_blend
    if light.type == 'AREA':
        found['shape'] = light.shape
        found['size'] = light.size
        # Blender keeps the second extent of shapes that have but one.
        two = light.shape in ('RECTANGLE', 'ELLIPSE')
        found['size_y'] = light.size_y if two else light.size
        found['spread'] = light.spread
    return found
