# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that read the surface: constants, attributes, normals, view-dependent factors."""

from .. import compat
from .compiler import value_node
from .spaces import radial_tangent
from .values import Value, socket_kind, socket_number

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
    if output == 'Parametric':
        code = 'vec3(hit.barycentrics.xy, 0.0)' if compiler.domain == 'material' else 'vec3(0.0)'
        return Value('vector', code)
    if output == 'Tangent' and compiler.domain == 'material':
        return radial_tangent(use, 'Z')
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


@value_node('FRESNEL')
def fresnel(use, output):
    """Fresnel node: reflectance of a dielectric, from inside for back faces."""
    compiler = use.compiler
    ior = use.declare('float', f'max({use.get("IOR", "float")}, 1e-5)').code
    if compiler.domain == 'material':
        ior = use.declare('float', f'hit.backfacing ? 1.0 / {ior} : {ior}').code
    return _fresnel(use, ior)


def _fresnel(use, ior):
    cosine = f'dot({use.compiler.view_vector()}, {use.normal()})'
    return use.declare('float', f'fresnel_dielectric({cosine}, {ior})')


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


@value_node('OBJECT_INFO')
def object_info(use, output):
    """Object Info node: the location; the rest are the answers for an object with nothing set."""
    compiler = use.compiler
    if output == 'Location' and compiler.domain == 'material':
        return use.declare('vector', 'fetch_transform(hit.instance, vec3(0.0)).translation')
    if output == 'Material Index':
        return compiler.parameter('float', float(compiler.pass_index))
    compiler.warn(use.node, 'that of a new object', f'has no {output} output yet')
    if output == 'Color':
        return compiler.parameter('color', (1.0, 1.0, 1.0))
    if output == 'Location':
        return compiler.parameter('vector', (0.0, 0.0, 0.0))
    return compiler.parameter('float', {'Alpha': 1.0, 'Random': 0.5}.get(output, 0.0))


@value_node('HAIR_INFO', 'CURVES_INFO', 'POINT_INFO', 'PARTICLE_INFO', 'VOLUME_INFO')
def not_of_meshes(use, output):
    """Nodes about hair, points, particles and volumes: nothing of these is there on a mesh."""
    compiler = use.compiler
    if use.node.type in ('PARTICLE_INFO', 'VOLUME_INFO'):
        compiler.warn(use.node, 'zero')
    socket = compat.find_socket(use.node.outputs, output)
    kind = socket_kind(socket)
    return compiler.parameter(kind, 0.0 if kind == 'float' else (0.0, 0.0, 0.0))


@value_node('AMBIENT_OCCLUSION')
def ambient_occlusion(use, output):
    """Ambient Occlusion node: nothing occludes."""
    use.compiler.warn(use.node, 'an open surface')
    if output == 'AO':
        return use.compiler.parameter('float', 1.0)
    return use.declare('color', use.get('Color', 'color'))


@value_node('LIGHT_FALLOFF')
def light_falloff(use, output):
    """Light Falloff node: the strength as it is, which a lamp's own falloff then shapes."""
    use.compiler.warn(use.node, 'the strength alone')
    return use.declare('float', use.get('Strength', 'float'))


@value_node('WIREFRAME')
def wireframe(use, output):
    """Wireframe node: no wires."""
    use.compiler.warn(use.node, 'zero')
    return use.compiler.parameter('float', 0.0)
