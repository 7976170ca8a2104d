# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that read the surface: constants, coordinates, attributes, normals, view-dependent factors."""

from mathutils import Euler, Matrix

from .compiler import value_node
from .values import Value, socket_number

# Light Path outputs as the camera sees them; every hit is shaded as a camera ray's for now.
_CAMERA_RAY = {'Is Camera Ray': 1.0, 'Is Singular Ray': 1.0}


@value_node('RGB')
def rgb(use, output):
    """RGB node."""
    return use.compiler.parameter('color', socket_number(use.node.outputs[0]))


@value_node('VALUE')
def value(use, output):
    """Value node."""
    return use.compiler.parameter('float', socket_number(use.node.outputs[0]))


@value_node('UVMAP')
def uv_map(use, output):
    """UV Map node."""
    return use.declare('vector', f'vec3({use.compiler.uv(use.node.uv_map)}, 0.0)')


@value_node('TEX_COORD')
def texture_coordinate(use, output):
    """Texture Coordinate node; Camera and Window are not offered by a hit."""
    compiler = use.compiler
    if output == 'UV':
        return use.declare('vector', f'vec3({compiler.uv("")}, 0.0)')
    if output == 'Generated':
        return use.declare('vector', compiler.generated())
    if output == 'Object':
        return _object_coordinate(use)
    if output == 'Normal':
        if compiler.domain == 'material':
            return use.declare('vector', f'{compiler.helper("node_object_normal")}(hit)')
        return Value('vector', compiler.shading_normal())
    if output == 'Reflection':
        return use.declare(
            'vector', f'reflect(-{compiler.view_vector()}, {compiler.shading_normal()})')
    compiler.warn(use.node, 'the world position', f'has no {output} output yet')
    return use.declare('vector', compiler.world_position())


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


def affine(compiler, matrix, point):
    """Return a vec3 expression for a 4x4 Matrix, kept in the parameter block, times a point."""
    first = compiler.parameters.table(matrix[row][:] for row in range(3))
    rows = ', '.join(f'dot(param({first + row}), vec4({point}, 1.0))' for row in range(3))
    return f'vec3({rows})'


@value_node('NEW_GEOMETRY')
def geometry(use, output):
    """Geometry node."""
    compiler = use.compiler
    if output == 'Position':
        return use.declare('vector', compiler.world_position())
    if output == 'Normal':
        return Value('vector', compiler.shading_normal())
    if output == 'True Normal':
        code = 'hit.geometric_normal' if compiler.domain == 'material' else '(-direction)'
        return Value('vector', code)
    if output == 'Incoming':
        return Value('vector', compiler.view_vector())
    if output == 'Backfacing':
        code = '(hit.backfacing ? 1.0 : 0.0)' if compiler.domain == 'material' else '0.0'
        return Value('float', code)
    compiler.warn(use.node, 'a constant', f'has no {output} output yet')
    if output in ('Pointiness', 'Random Per Island'):
        return compiler.parameter('float', 0.5)
    return compiler.parameter('vector', (0.0, 0.0, 0.0))


@value_node('ATTRIBUTE')
def attribute(use, output):
    """Attribute node, for attributes of the mesh."""
    compiler = use.compiler
    name = use.node.attribute_name
    if use.node.attribute_type != 'GEOMETRY' or not name or compiler.domain != 'material':
        compiler.warn(use.node, 'black', 'reads attributes of meshes only')
        kind = {'Color': 'color', 'Vector': 'vector'}.get(output, 'float')
        return compiler.parameter(kind, 0.0 if kind == 'float' else (0.0, 0.0, 0.0))
    return _color_output(use, name, output)


@value_node('VERTEX_COLOR')
def color_attribute(use, output):
    """Color Attribute node (Vertex Color in older files)."""
    if use.compiler.domain != 'material':
        kind = 'float' if output == 'Alpha' else 'color'
        return use.compiler.parameter(kind, 0.0 if kind == 'float' else (0.0, 0.0, 0.0))
    return _color_output(use, use.node.layer_name, output)


def _color_output(use, name, output):
    compiler = use.compiler
    key = ('color attribute', use.scope.path, use.node.as_pointer())
    argument = compiler.attribute(name) if name else 'COLOR_DEFAULT'
    variable = compiler.shared(key, lambda: compiler.declare_vec4(f'hit_color(hit, {argument})'))
    if output == 'Alpha':
        return Value('float', f'{variable}.w')
    if output == 'Fac':
        return Value('float', f'(dot({variable}.xyz, vec3(1.0)) * (1.0 / 3.0))')
    return Value('vector' if output == 'Vector' else 'color', f'{variable}.xyz')


@value_node('NORMAL_MAP')
def normal_map(use, output):
    """Normal Map node in tangent, object and world space (and Blender's own two)."""
    compiler, node = use.compiler, use.node
    if compiler.domain != 'material':
        return Value('vector', compiler.shading_normal())
    color = use.get('Color', 'color')
    if getattr(node, 'convention', 'OPENGL') == 'DIRECTX':
        color = use.declare('color', f'vec3({color})').code
        color = f'vec3({color}.x, 1.0 - {color}.y, {color}.z)'
    strength = use.get('Strength', 'float')
    compiler.facts['normal_map'] = True
    if node.space == 'TANGENT':
        argument = compiler.attribute(node.uv_map) if node.uv_map else 'UV_DEFAULT'
        return use.declare('vector', f'normal_map_tangent(hit, {argument}, {color}, {strength})')
    if node.space.startswith('BLENDER_'):
        # Baked by old versions of Blender, with Y and Z reversed.
        color = use.declare('color', f'vec3({color})').code
        color = f'vec3({color}.x, 1.0 - {color}.y, 1.0 - {color}.z)'
    space = 'object' if node.space.endswith('OBJECT') else 'world'
    return use.declare('vector', f'normal_map_{space}(hit, {color}, {strength})')


@value_node('BUMP')
def bump(use, output):
    """Bump node: its height is not read yet."""
    use.compiler.warn(use.node, 'the normal that it starts from')
    return Value('vector', use.normal())


@value_node('FRESNEL')
def fresnel(use, output):
    """Fresnel node: reflectance of a dielectric, from inside for back faces."""
    compiler = use.compiler
    ior = use.declare('float', f'max({use.get("IOR", "float")}, 1e-5)').code
    if compiler.domain == 'material':
        ior = use.declare('float', f'hit.backfacing ? 1.0 / {ior} : {ior}').code
    return _fresnel(use, ior)


def _fresnel(use, ior):
    function = use.compiler.helper('node_fresnel')
    cosine = f'dot({use.compiler.view_vector()}, {use.normal()})'
    return use.declare('float', f'{function}({cosine}, {ior})')


@value_node('LAYER_WEIGHT')
def layer_weight(use, output):
    """Layer Weight node."""
    compiler = use.compiler
    blend = use.get('Blend', 'float')
    if output == 'Fresnel':
        ior = use.declare('float', f'max(1.0 - ({blend}), 1e-5)').code
        if compiler.domain == 'material':
            ior = use.declare('float', f'hit.backfacing ? {ior} : 1.0 / {ior}').code
        else:
            ior = f'(1.0 / {ior})'
        return _fresnel(use, ior)
    limited = use.declare('float', f'clamp({blend}, 0.0, 1.0 - 1e-5)').code
    exponent = f'({limited} < 0.5 ? 2.0 * {limited} : 0.5 / (1.0 - {limited}))'
    cosine = f'abs(dot({compiler.view_vector()}, {use.normal()}))'
    return use.declare('float', f'1.0 - pow({cosine}, {exponent})')


@value_node('LIGHT_PATH')
def light_path(use, output):
    """Light Path node: the answers for a camera ray."""
    use.compiler.warn(use.node, 'its answer for camera rays')
    return use.compiler.parameter('float', _CAMERA_RAY.get(output, 0.0))


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
