# SPDX-License-Identifier: GPL-3.0-or-later
"""Colour nodes: Mix, Invert, Gamma, Brightness/Contrast, Hue/Saturation, RGB to BW."""

from . import color_helpers  # noqa: F401 (registers the GLSL)
from .compiler import value_node
from .values import Value

# Blend modes as expressions of the factor f and the colours a and b; the others are helpers.
_BLEND = {
    'MIX': 'mix({a}, {b}, {f})',
    'DARKEN': 'mix({a}, min({a}, {b}), {f})',
    'MULTIPLY': 'mix({a}, {a} * {b}, {f})',
    'LIGHTEN': 'mix({a}, max({a}, {b}), {f})',
    'SCREEN': '1.0 - (1.0 - {f} + {f} * (1.0 - {b})) * (1.0 - {a})',
    'ADD': 'mix({a}, {a} + {b}, {f})',
    'SUBTRACT': 'mix({a}, {a} - {b}, {f})',
    'DIFFERENCE': 'mix({a}, abs({a} - {b}), {f})',
    'EXCLUSION': 'max(mix({a}, {a} + {b} - 2.0 * {a} * {b}, {f}), vec3(0.0))',
    'LINEAR_LIGHT': '{a} + {f} * (2.0 * {b} - 1.0)',
}
_BLEND_HELPERS = ('BURN', 'DODGE', 'OVERLAY', 'SOFT_LIGHT', 'DIVIDE', 'HUE', 'SATURATION', 'COLOR',
                  'VALUE')


def blend(use, mode, factor, a, b, clamp):
    """Return the `Value` of two colour expressions blended as the Mix node's `mode` does."""
    compiler = use.compiler
    f = use.declare('float', factor).code
    a = use.declare('color', a).code
    b = use.declare('color', b).code
    if mode in _BLEND_HELPERS:
        code = f'{compiler.helper("node_blend_" + mode.lower())}({f}, {a}, {b})'
    else:
        if mode not in _BLEND:
            compiler.warn(use.node, 'a plain mix', f'has no mode {mode.title()} yet')
            mode = 'MIX'
        code = _BLEND[mode].format(f=f, a=a, b=b)
    if clamp:
        code = f'clamp({code}, 0.0, 1.0)'
    return use.declare('color', code)


@value_node('MIX_RGB')
def mix_rgb(use, output):
    """Mix node of files before 3.4."""
    factor = f'clamp({use.get("Fac", "float")}, 0.0, 1.0)'
    return blend(use, use.node.blend_type, factor, use.get('Color1', 'color'),
                 use.get('Color2', 'color'), use.node.use_clamp)


@value_node('MIX')
def mix(use, output):
    """Mix node: floats, vectors (one factor or three) and colours."""
    node = use.node
    suffix = {'FLOAT': 'Float', 'VECTOR': 'Vector', 'RGBA': 'Color'}.get(node.data_type)
    if suffix is None:
        use.compiler.warn(node, 'its first input', f'does not mix {node.data_type.title()} yet')
        return Value('vector', use.get('A_Vector', 'vector'))
    kind = {'Float': 'float', 'Vector': 'vector', 'Color': 'color'}[suffix]
    by_component = node.data_type == 'VECTOR' and node.factor_mode == 'NON_UNIFORM'
    factor = use.get('Factor_Vector', 'vector') if by_component else use.get('Factor_Float', 'float')
    if node.clamp_factor:
        factor = f'clamp({factor}, 0.0, 1.0)'
    a, b = use.get(f'A_{suffix}', kind), use.get(f'B_{suffix}', kind)
    if kind == 'color':
        return blend(use, node.blend_type, factor, a, b, node.clamp_result)
    return use.declare(kind, f'mix({a}, {b}, {factor})')


@value_node('INVERT')
def invert(use, output):
    """Invert Color node."""
    color = use.declare('color', use.get('Color', 'color')).code
    return use.declare('color', f'mix({color}, 1.0 - {color}, {use.get("Fac", "float")})')


@value_node('GAMMA')
def gamma(use, output):
    """Gamma node."""
    function = use.compiler.helper('node_gamma')
    return use.declare(
        'color', f'{function}({use.get("Color", "color")}, {use.get("Gamma", "float")})')


@value_node('BRIGHTCONTRAST')
def brightness_contrast(use, output):
    """Brightness/Contrast node."""
    contrast = use.declare('float', use.get('Contrast', 'float')).code
    color, bright = use.get('Color', 'color'), use.get('Bright', 'float')
    return use.declare(
        'color',
        f'max((1.0 + {contrast}) * {color} + ({bright} - 0.5 * {contrast}), vec3(0.0))')


@value_node('HUE_SAT')
def hue_saturation(use, output):
    """Hue/Saturation/Value node."""
    function = use.compiler.helper('node_hue_saturation')
    numbers = ', '.join(use.get(name, 'float') for name in ('Hue', 'Saturation', 'Value', 'Fac'))
    return use.declare('color', f'{function}({use.get("Color", "color")}, {numbers})')


@value_node('RGBTOBW')
def rgb_to_bw(use, output):
    """RGB to BW node: luminance, as a link from a colour to a float gives it."""
    return use.declare('float', use.get('Color', 'float'))
