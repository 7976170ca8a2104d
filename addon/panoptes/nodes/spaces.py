# SPDX-License-Identifier: GPL-3.0-or-later
"""Coordinates and how they change: Texture Coordinate, Camera Data, Mapping, Vector Rotate and
Transform, Tangent.
"""

from mathutils import Euler, Matrix

from .compiler import value_node
from .values import Value

# The object's rotation and scale.
LINEAR = 'fetch_transform(hit.instance, vec3(0.0)).linear'


def affine(compiler, matrix, point):
    """Return a vec3 expression for a 4x4 Matrix, kept in the parameter block, times a point."""
    first = compiler.parameters.table(matrix[row][:] for row in range(3))
    rows = ', '.join(f'dot(param({first + row}), vec4({point}, 1.0))' for row in range(3))
    return f'vec3({rows})'


@value_node('TEX_COORD')
def texture_coordinate(use, output):
    """Texture Coordinate node; in a world's tree everything is the direction."""
    compiler, material = use.compiler, use.compiler.domain == 'material'
    if use.node.from_instancer:
        compiler.warn(use.node, "the object's own", 'has no coordinates of an instancer yet')
    if output == 'UV':
        return use.declare('vector', f'vec3({compiler.uv("")}, 0.0)')
    if output == 'Generated':
        return use.declare('vector', compiler.generated())
    if output == 'Object':
        return _object_coordinate(use)
    if output == 'Normal':
        if material:
            return use.declare('vector', f'normal_to_object({LINEAR}, {compiler.shading_normal()})')
        return Value('vector', compiler.shading_normal())
    if output == 'Reflection':
        return use.declare(
            'vector', f'reflect(-{compiler.view_vector()}, {compiler.shading_normal()})')
    if not material:
        compiler.warn(use.node, 'the direction', f'has no {output} output in worlds yet')
        return Value('vector', 'direction')
    position = compiler.world_position()
    function = compiler.helper('node_window' if output == 'Window' else 'node_to_camera')
    return use.declare('vector', f'{function}({position}, 1.0)')


def _object_coordinate(use):
    """Coordinates in the space of the node's object, or of the shaded object itself."""
    compiler = use.compiler
    target = use.node.object
    if target is None:
        if compiler.domain == 'material':
            return use.declare('vector', 'hit_object_position(hit)')
        return Value('vector', 'direction')
    # Another object's transform may change without this material being told.
    compiler.depends_on_objects = True
    inverse = target.matrix_world.inverted_safe()
    return use.declare('vector', affine(compiler, inverse, compiler.world_position()))


@value_node('CAMERA')
def camera_data(use, output):
    """Camera Data node."""
    compiler = use.compiler
    function = compiler.helper('node_to_camera')
    key = ('camera data', compiler.world_position())
    place = compiler.shared(key, lambda: use.declare(
        'vector', f'{function}({compiler.world_position()}, 1.0)').code)
    if output == 'View Z Depth':
        return Value('float', f'{place}.z')
    if output == 'View Distance':
        return use.declare('float', f'length({place})')
    return use.declare('vector', f'normalize({place})')


@value_node('MAPPING')
def mapping(use, output):
    """Mapping node; with nothing linked but the vector, one matrix from the parameter block."""
    compiler = use.compiler
    vector = use.get('Vector', 'vector')
    kind = use.node.vector_type
    moves = kind in ('POINT', 'TEXTURE')
    names = ('Rotation', 'Scale') + (('Location',) if moves else ())
    constants = {name: use.constant(name) for name in names}
    if kind != 'NORMAL' and None not in constants.values():
        return use.declare('vector', affine(compiler, _mapping_matrix(kind, constants), vector))

    vector = use.declare('vector', vector).code
    rotation = use.declare('vector', use.get('Rotation', 'vector')).code
    scale = use.declare('vector', use.get('Scale', 'vector')).code
    location = use.declare('vector', use.get('Location', 'vector')).code if moves else None
    rotate = f'{compiler.helper("node_euler")}({rotation})'
    if kind == 'POINT':
        return use.declare('vector', f'{rotate} * ({vector} * {scale}) + {location}')
    if kind == 'VECTOR':
        return use.declare('vector', f'{rotate} * ({vector} * {scale})')
    divide = compiler.helper('node_divide')
    if kind == 'TEXTURE':
        back = f'transpose({rotate}) * ({vector} - {location})'
        return use.declare('vector', f'{divide}({back}, {scale})')
    normalize = compiler.helper('node_safe_normalize')
    return use.declare('vector', f'{normalize}({rotate} * {divide}({vector}, {scale}))')


def _mapping_matrix(kind, constants):
    """Return the 4x4 Matrix of a Mapping node whose settings are all constants."""
    rotation = Euler(constants['Rotation'], 'XYZ').to_matrix().to_4x4()
    scale = constants['Scale']
    if kind == 'TEXTURE':
        inverse = Matrix.Diagonal([1.0 / s if s != 0.0 else 0.0 for s in scale] + [1.0])
        move = Matrix.Translation([-c for c in constants['Location']])
        return inverse @ rotation.transposed() @ move
    matrix = rotation @ Matrix.Diagonal([*scale, 1.0])
    if kind == 'POINT':
        matrix = Matrix.Translation(constants['Location']) @ matrix
    return matrix


@value_node('VECTOR_ROTATE')
def vector_rotate(use, output):
    """Vector Rotate node."""
    compiler, kind = use.compiler, use.node.rotation_type
    vector = use.declare('vector', use.get('Vector', 'vector')).code
    center = use.declare('vector', use.get('Center', 'vector')).code
    if kind == 'EULER_XYZ':
        rotate = f'{compiler.helper("node_euler")}({use.get("Rotation", "vector")})'
        if use.node.invert:
            rotate = f'transpose({rotate})'
        return use.declare('vector', f'{rotate} * ({vector} - {center}) + {center}')
    axes = {'X_AXIS': 'vec3(1.0, 0.0, 0.0)', 'Y_AXIS': 'vec3(0.0, 1.0, 0.0)',
            'Z_AXIS': 'vec3(0.0, 0.0, 1.0)'}
    axis = axes.get(kind) or use.get('Axis', 'vector')
    angle = f'{"-" if use.node.invert else ""}({use.get("Angle", "float")})'
    function = compiler.helper('node_rotate')
    return use.declare('vector', f'{function}({vector} - {center}, {axis}, {angle}) + {center}')


@value_node('VECT_TRANSFORM')
def vector_transform(use, output):
    """Vector Transform node."""
    compiler, node = use.compiler, use.node
    vector = use.get('Vector', 'vector')
    start, end, kind = node.convert_from, node.convert_to, node.vector_type
    if start == end:
        return use.declare('vector', vector)
    if compiler.domain != 'material' and 'OBJECT' in (start, end):
        compiler.warn(node, 'the vector as it is', 'knows no object in worlds')
        return use.declare('vector', vector)
    # Points feel where a space begins, directions do not; normals go as directions, as in Cycles.
    point = '1.0' if kind == 'POINT' else '0.0'
    if start == 'OBJECT':
        vector = f'{compiler.helper("node_object_to_world")}(hit, {vector}, {point})'
    elif start == 'CAMERA':
        vector = f'{compiler.helper("node_from_camera")}({vector}, {point})'
    if end == 'OBJECT':
        vector = f'{compiler.helper("node_world_to_object")}(hit, {vector}, {point})'
    elif end == 'CAMERA':
        vector = f'{compiler.helper("node_to_camera")}({vector}, {point})'
    if kind == 'NORMAL':
        vector = f'{compiler.helper("node_safe_normalize")}({vector})'
    return use.declare('vector', vector)


# The directions around each axis of the bounding box, from its middle g.
_RADIAL = {'X': 'vec3(0.0, -{g}.z, {g}.y)', 'Y': 'vec3(-{g}.z, 0.0, {g}.x)',
           'Z': 'vec3(-{g}.y, {g}.x, 0.0)'}


@value_node('TANGENT')
def tangent(use, output):
    """Tangent node."""
    node = use.node
    if use.compiler.domain != 'material':
        return Value('vector', 'vec3(0.0)')
    if node.direction_type == 'RADIAL':
        return radial_tangent(use, node.axis)
    argument = use.compiler.attribute(node.uv_map) if node.uv_map else 'UV_DEFAULT'
    return _level(use, f'uv_tangent(hit, {argument})')


def radial_tangent(use, axis):
    """The direction around an axis of the object, along the surface."""
    middle = use.declare('vector', f'{use.compiler.generated()} - 0.5').code
    return _level(use, f'normal_to_world({LINEAR}, {_RADIAL[axis].format(g=middle)})')


def _level(use, direction):
    """Turn a direction into the surface's plane."""
    normal = use.compiler.shading_normal()
    normalize = use.compiler.helper('node_safe_normalize')
    return use.declare('vector', f'cross({normal}, {normalize}(cross({direction}, {normal})))')


@value_node('NORMAL')
def normal(use, output):
    """Normal node: a direction, and its cosine with the input."""
    direction = use.compiler.parameter('vector', tuple(use.node.outputs[0].default_value))
    if output == 'Normal':
        return direction
    normalize = use.compiler.helper('node_safe_normalize')
    return use.declare('float', f'dot({normalize}({direction.code}), '
                                f'{normalize}({use.get("Normal", "vector")}))')
