# SPDX-License-Identifier: GPL-3.0-or-later
"""Image Texture and Environment Texture."""

from mathutils import Euler, Matrix

from .. import compat
from .compiler import value_node
from .spaces import LINEAR, affine
from .values import Value

# Colour of a texture that cannot be found, as everywhere in Blender.
MISSING = (1.0, 0.0, 1.0)


def _missing(use, output):
    use.compiler.warn_once(
        ('no image', use.node.name),
        f'{use.compiler.owner}: node {use.node.name} has no image; choose one in the node, '
        'magenta is shown until then.')
    if output == 'Alpha':
        return use.compiler.parameter('float', 1.0)
    return use.compiler.parameter('color', MISSING)


def _sampler(use, extension):
    """Return (slot, name of the GLSL macro) that reads the node's image."""
    node = use.node
    interpolation = 'CLOSEST' if node.interpolation == 'Closest' else 'LINEAR'
    slot = use.compiler.texture(node.image, interpolation, extension, node.image_user)
    # Smart is cubic where it magnifies, and Cycles takes it for cubic everywhere.
    cubic = node.interpolation in ('Cubic', 'Smart')
    return slot, 'sample_image_cubic' if cubic else 'sample_image_wide'


@value_node('TEX_IMAGE')
def image(use, output):
    """Image Texture node.

    The colour is premultiplied unless the Alpha output is used as well (then it is divided out,
    because the tree combines the two itself), as in Cycles.
    """
    compiler, node = use.compiler, use.node
    if node.image is None:
        return _missing(use, output)

    def create():
        extension = node.extension if node.extension in ('EXTEND', 'CLIP') else 'REPEAT'
        mirror = node.extension == 'MIRROR'
        slot, function = _sampler(use, 'EXTEND' if mirror else extension)
        divide = use.output_used('Alpha') and compat.image_has_straight_color(node.image)
        flag = 'true' if divide else 'false'

        def sample(uv, width):
            if mirror:
                uv = f'abs(mod({uv} - 1.0, 2.0) - 1.0)'
            return f'{function}({slot}, {uv}, {width}, {flag})'

        if node.projection == 'BOX':
            return _box(use, sample)
        return compiler.declare_vec4(sample(*_flat_coordinate(use)))

    key = ('image', use.scope.path, node.as_pointer())
    texel = compiler.shared(key, create)
    return Value('float', f'{texel}.w') if output == 'Alpha' else Value('color', f'{texel}.xyz')


def _flat_coordinate(use):
    """Return (vec2 expression at which an image is read, its width in a pixel)."""
    compiler, node = use.compiler, use.node
    name = _plain_uv_map(use)
    if name is not None:
        # The common case reads the UV map directly, without a trip through vec3.
        argument = compiler.attribute(name) if name else 'UV_DEFAULT'
        return f'hit_uv(hit, {argument})', f'uv_width(hit, {argument})'

    def create():
        vector = mapped(use)
        if node.projection == 'FLAT':
            return vector
        function = compiler.helper(
            'node_sphere_map' if node.projection == 'SPHERE' else 'node_tube_map')
        return f'vec3({function}({vector} * 2.0 - 1.0), 0.0)'

    place, width = _with_width(compiler, create)
    return f'{place}.xy', width


def _plain_uv_map(use):
    """Return the UV map ('' for the default one) whose coordinates an image uses as they are."""
    node = use.node
    if use.compiler.domain != 'material' or node.projection != 'FLAT' or _has_mapping(node):
        return None
    if not use.is_linked('Vector'):
        return ''
    source = use.source('Vector')
    if source.kinds != ('vector',):
        return None
    if source.node.type == 'UVMAP':
        return source.node.uv_map
    is_uv = source.node.type == 'TEX_COORD' and source.socket.identifier == 'UV'
    return '' if is_uv else None


def _with_width(compiler, create):
    """Return (vec3 variable of what `create()` returns, how far it runs across the pixel).

    The tree that leads to a coordinate may be any: the width is that of its difference to two places
    beside the hit, the smaller of the two.
    """
    if compiler.domain != 'material':
        return compiler.declare('vector', create()).code, '0.0'
    name = compiler.function('coordinate', create, 'vector')
    x = compiler.declare('vector', 'bump_offset_x(hit)').code
    y = compiler.declare('vector', f'bump_offset_y(hit, {x})').code
    place = compiler.declare('vector', f'{name}(hit)').code
    beside = ', '.join(f'distance({place}, {name}(shifted_hit(hit, {offset})))' for offset in (x, y))
    return place, compiler.declare('float', f'min({beside})').code


def _box(use, sample):
    """Return a vec4 variable: the image projected along three axes, blended by the normal."""
    compiler, node = use.compiler, use.node
    if compiler.domain == 'material':
        normal = f'normal_to_object({LINEAR}, {compiler.shading_normal()})'
    else:
        normal = compiler.shading_normal()
    normal = compiler.declare('vector', normal).code
    blend = compiler.parameter('float', node.projection_blend).code
    weights = compiler.helper('node_box_weights')
    weight = compiler.declare('vector', f'{weights}({normal}, {blend})').code
    place, width = _with_width(compiler, lambda: mapped(use))

    def side(axis, across, up, turned):
        u = f'({normal}.{axis} {turned} 0.0 ? 1.0 - {place}.{across} : {place}.{across})'
        return f'{weight}.{axis} * {sample(f"vec2({u}, {place}.{up})", width)}'

    return compiler.declare_vec4(
        ' + '.join((side('x', 'y', 'z', '<'), side('y', 'x', 'z', '>'), side('z', 'y', 'x', '>'))))


def _has_mapping(node):
    """Tell whether the node's own (hidden) texture mapping moves its coordinates."""
    mapping = getattr(node, 'texture_mapping', None)
    return mapping is not None and (tuple(mapping.translation) != (0.0, 0.0, 0.0)
                                    or tuple(mapping.rotation) != (0.0, 0.0, 0.0)
                                    or tuple(mapping.scale) != (1.0, 1.0, 1.0))


def mapped(use):
    """Return a texture node's vector as a vec3 variable, moved by its own texture mapping."""
    compiler, node = use.compiler, use.node
    if use.is_linked('Vector') or node.type == 'TEX_WHITE_NOISE':
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
    """Environment Texture node, both projections."""
    compiler, node = use.compiler, use.node
    if node.image is None:
        return _missing(use, output)
    projection = compiler.helper(
        'node_mirror_ball' if node.projection == 'MIRROR_BALL' else 'node_equirectangular')
    slot, function = _sampler(use, 'REPEAT')
    # Where the map meets itself differences mean nothing: the finest level is read.
    texel = compiler.declare_vec4(f'{function}({slot}, {projection}({mapped(use)}), 0.0, false)')
    return Value('color', f'{texel}.xyz')
