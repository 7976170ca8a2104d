# SPDX-License-Identifier: GPL-3.0-or-later
"""Procedural textures: Checker, Gradient."""

from .compiler import value_node
from .images import mapped
from .values import Value

_GRADIENTS = {
    'LINEAR': '{p}.x',
    'QUADRATIC': 'max({p}.x, 0.0) * max({p}.x, 0.0)',
    'EASING': 'smoothstep(0.0, 1.0, {p}.x)',
    'DIAGONAL': '({p}.x + {p}.y) * 0.5',
    'RADIAL': '(({p}.x == 0.0 && {p}.y == 0.0) ? 0.5 : atan({p}.y, {p}.x) / 6.28318531 + 0.5)',
    'SPHERICAL': 'max(0.999999 - length({p}), 0.0)',
    'QUADRATIC_SPHERE': 'max(0.999999 - length({p}), 0.0) * max(0.999999 - length({p}), 0.0)',
}


@value_node('TEX_CHECKER')
def checker(use, output):
    """Checker Texture node."""

    def create():
        function = use.compiler.helper('node_checker')
        vector = mapped(use)
        return use.declare('float', f'{function}({vector} * {use.get("Scale", "float")})').code

    key = ('checker', use.scope.path, use.node.as_pointer())
    factor = use.compiler.shared(key, create)
    if output == 'Fac':
        return Value('float', factor)
    first, second = use.get('Color1', 'color'), use.get('Color2', 'color')
    return use.declare('color', f'mix({second}, {first}, {factor})')


@value_node('TEX_GRADIENT')
def gradient(use, output):
    """Gradient Texture node."""
    position = mapped(use)
    code = _GRADIENTS[use.node.gradient_type].format(p=position)
    factor = use.declare('float', f'clamp({code}, 0.0, 1.0)')
    return factor if output == 'Fac' else Value('color', f'vec3({factor.code})')
