# SPDX-License-Identifier: GPL-3.0-or-later
"""Texture nodes: Image, Environment, Checker, Gradient."""

from mathutils import Euler, Matrix

from .. import compat
from .compiler import value_node
from .spaces import affine
from .values import Value

# Colour of a texture that cannot be found, as everywhere in Blender.
MISSING = (1.0, 0.0, 1.0)

_GRADIENTS = {
    'LINEAR': '{p}.x',
    'QUADRATIC': 'max({p}.x, 0.0) * max({p}.x, 0.0)',
    'EASING': 'smoothstep(0.0, 1.0, {p}.x)',
    'DIAGONAL': '({p}.x + {p}.y) * 0.5',
    'RADIAL': '(({p}.x == 0.0 && {p}.y == 0.0) ? 0.5 : atan({p}.y, {p}.x) / 6.28318531 + 0.5)',
    'SPHERICAL': 'max(0.999999 - length({p}), 0.0)',
    'QUADRATIC_SPHERE': 'max(0.999999 - length({p}), 0.0) * max(0.999999 - length({p}), 0.0)',
}


def _missing(use, output):
    use.compiler.warn_once(
        ('no image', use.node.name),
        f'{use.compiler.owner}: node {use.node.name} has no image; choose one in the node, '
        'magenta is shown until then.')
    if output == 'Alpha':
        return use.compiler.parameter('float', 1.0)
    return use.compiler.parameter('color', MISSING)


def _interpolation(node):
    """Map the node's interpolation to what the sampler offers: 'LINEAR' or 'CLOSEST'."""
    return 'CLOSEST' if node.interpolation == 'Closest' else 'LINEAR'


@value_node('TEX_IMAGE')
def image(use, output):
    """Image Texture node.

    The colour is premultiplied unless the Alpha output is used as well (then it is divided out,
    because the tree combines the two itself), as in Cycles.
    """
    compiler, node = use.compiler, use.node
    if node.image is None:
        return _missing(use, output)
    if compiler.domain != 'material':
        compiler.warn(node, 'a medium grey', 'works in materials only (use an Environment Texture)')
        return compiler.parameter('color' if output == 'Color' else 'float',
                                  (0.5, 0.5, 0.5) if output == 'Color' else 1.0)

    def create():
        uv = _image_coordinate(use)
        extension = node.extension if node.extension in ('EXTEND', 'CLIP') else 'REPEAT'
        if node.extension == 'MIRROR':
            uv = use.compiler.declare('vector', f'vec3(abs(mod({uv} - 1.0, 2.0) - 1.0), 0.0)').code
            uv, extension = f'{uv}.xy', 'EXTEND'
        slot = compiler.texture(node.image, _interpolation(node), extension, node.image_user)
        divide = use.output_used('Alpha') and compat.image_has_straight_color(node.image)
        flag = 'true' if divide else 'false'
        return compiler.declare_vec4(f'sample_image(hit, {slot}, {uv}, {flag})')

    key = ('image', use.scope.path, node.as_pointer())
    texel = compiler.shared(key, create)
    return Value('float', f'{texel}.w') if output == 'Alpha' else Value('color', f'{texel}.xyz')


def _image_coordinate(use):
    """Return the vec2 expression at which an Image Texture node is read."""
    compiler, node = use.compiler, use.node
    linked = use.is_linked('Vector')
    projection = node.projection
    if projection == 'BOX':
        compiler.warn(node, 'flat projection', 'has no box projection yet')
        projection = 'FLAT'
    if projection == 'FLAT':
        if not linked:
            # The common case reads the UV map directly, without a trip through vec3.
            return compiler.uv('') if not _has_mapping(node) else _mapped(use, linked) + '.xy'
        return _mapped(use, linked) + '.xy'
    function = compiler.helper('node_sphere_map' if projection == 'SPHERE' else 'node_tube_map')
    return f'{function}({_mapped(use, linked)} * 2.0 - 1.0)'


def _has_mapping(node):
    """Tell whether the node's own (hidden) texture mapping moves its coordinates."""
    mapping = node.texture_mapping
    return (tuple(mapping.translation) != (0.0, 0.0, 0.0)
            or tuple(mapping.rotation) != (0.0, 0.0, 0.0)
            or tuple(mapping.scale) != (1.0, 1.0, 1.0))


def _mapped(use, linked):
    """Return the node's vector as a vec3 variable, moved by its own texture mapping."""
    compiler, node = use.compiler, use.node
    if linked:
        vector = use.get('Vector', 'vector')
    elif node.type == 'TEX_IMAGE':
        vector = f'vec3({compiler.uv("")}, 0.0)'
    elif node.type == 'TEX_ENVIRONMENT':
        vector = compiler.world_position()
    else:
        vector = compiler.generated()
    if _has_mapping(node):
        mapping = node.texture_mapping
        matrix = (Matrix.Translation(mapping.translation)
                  @ Euler(mapping.rotation).to_matrix().to_4x4()
                  @ Matrix.Diagonal([*mapping.scale, 1.0]))
        vector = affine(compiler, matrix, vector)
    return compiler.declare('vector', vector).code


@value_node('TEX_ENVIRONMENT')
def environment(use, output):
    """Environment Texture node."""
    compiler, node = use.compiler, use.node
    if node.image is None:
        return _missing(use, output)
    if node.projection != 'EQUIRECTANGULAR':
        compiler.warn(node, 'equirectangular projection', 'has no mirror ball projection yet')
    direction = _mapped(use, use.is_linked('Vector'))
    slot = compiler.texture(node.image, _interpolation(node), 'REPEAT', node.image_user)
    if compiler.domain == 'material':
        uv = f'{compiler.helper("node_equirectangular")}({direction})'
        texel = compiler.declare_vec4(f'sample_image(hit, {slot}, {uv}, false)')
    else:
        texel = compiler.declare_vec4(f'sample_environment({slot}, {direction})')
    return Value('color', f'{texel}.xyz')


@value_node('TEX_CHECKER')
def checker(use, output):
    """Checker Texture node."""

    def create():
        function = use.compiler.helper('node_checker')
        vector = _mapped(use, use.is_linked('Vector'))
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
    position = _mapped(use, use.is_linked('Vector'))
    code = _GRADIENTS[use.node.gradient_type].format(p=position)
    factor = use.declare('float', f'clamp({code}, 0.0, 1.0)')
    return factor if output == 'Fac' else Value('color', f'vec3({factor.code})')
