# SPDX-License-Identifier: GPL-3.0-or-later
"""Shader nodes of worlds: everything ends as one radiance for a direction.

Beside the code, the radiance is computed as numbers where the tree allows it: a world that is the
same in all directions needs no sampling.
"""

from .closures import mix_factor, order_shaders
from .values import convert, socket_kind


def write_world(compiler, root):
    """Write a world's shaders; return (radiance expression, constant radiance or None)."""
    terms, constant = [], (0.0, 0.0, 0.0)
    weights = {}
    order = order_shaders(compiler, root)
    if order:
        weights[order[0][0]] = [('1.0', 1.0)]
    for key, use, source, children in order:
        arriving = weights.get(key)
        if not arriving:
            continue
        weight, number = _sum(compiler, arriving)
        if use.node.type in ('MIX_SHADER', 'ADD_SHADER'):
            factor = mix_factor(use) if any(role != 'same' for _, role in children) else None
            for child, role in children:
                weights.setdefault(child, []).append(_scaled(weight, number, factor, role))
            continue
        radiance, radiance_number = _radiance(compiler, use, source)
        terms.append(f'{weight} * ({radiance})')
        if constant is not None:
            if number is None or radiance_number is None:
                constant = None
            else:
                constant = tuple(c + number * r for c, r in zip(constant, radiance_number))
    return ' + '.join(terms) or 'vec3(0.0)', constant


def _sum(compiler, arriving):
    numbers = [number for _, number in arriving]
    total = None if None in numbers else sum(numbers)
    if len(arriving) == 1:
        return arriving[0][0], total
    return compiler.declare('float', ' + '.join(code for code, _ in arriving)).code, total


def _scaled(weight, number, factor, role):
    """Return (weight expression, weight number or None) of one side of a mix."""
    if role == 'same':
        return weight, number
    share = factor.code if role == 'second' else f'(1.0 - {factor.code})'
    if factor.constant is None or number is None:
        return f'{weight} * {share}', None
    part = factor.constant if role == 'second' else 1.0 - factor.constant
    return f'{weight} * {share}', number * part


def _radiance(compiler, use, source):
    """Return (radiance expression, numbers or None) of one shader of the world."""
    if socket_kind(source.socket) != 'shader':
        value = convert(compiler.source_value(source._replace(kinds=('color',))), 'color')
        return value.code, value.constant
    if use.node.type not in ('BACKGROUND', 'EMISSION'):
        compiler.warn(use.node, 'black')
        return 'vec3(0.0)', (0.0, 0.0, 0.0)
    color = convert(use.value('Color'), 'color')
    strength = convert(use.value('Strength'), 'float')
    if strength.constant == 0.0:
        return 'vec3(0.0)', (0.0, 0.0, 0.0)
    number = None
    if color.constant is not None and strength.constant is not None:
        number = tuple(c * strength.constant for c in color.constant)
    return f'{color.code} * {strength.code}', number
