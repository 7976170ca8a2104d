# SPDX-License-Identifier: GPL-3.0-or-later
"""Shader nodes of surfaces: closures with weights.

`order_shaders` brings the shader nodes under an output into an order in which every node comes
after all that use it, so that each closure is written once with the sum of its weights, however
many mixes lead to it.
"""

from .compiler import NodeUse
from .scope import resolve
from .values import Value, convert, socket_kind

CLOSURES = {}


def closure(*types):
    """Register a function (node use, weight expression) that writes these nodes' closures."""

    def register(function):
        for node_type in types:
            CLOSURES[node_type] = function
        return function

    return register


def _shader_inputs(node):
    return [socket for socket in node.inputs if socket_kind(socket) == 'shader']


def mix_factor(use):
    """Return the `Value` of a Mix Shader's factor, limited to 0..1."""
    constant = use.constant('Fac')
    if constant is not None and constant in (0.0, 1.0):
        return Value('float', f'{constant:.1f}', constant)
    value = convert(use.value('Fac'), 'float')
    limited = None if value.constant is None else min(max(value.constant, 0.0), 1.0)
    return use.declare('float', f'clamp({value.code}, 0.0, 1.0)')._replace(constant=limited)


def _children(compiler, use):
    """Return [(source, role)] of a mix or add node: role 'first', 'second' or 'same'."""
    sockets = _shader_inputs(use.node)
    if use.node.type == 'ADD_SHADER':
        return [(resolve(use.scope, socket), 'same') for socket in sockets]
    if use.node.type != 'MIX_SHADER':
        return []
    # A side that a constant factor switches off is not looked at: it costs nothing.
    constant = use.constant('Fac')
    roles = list(zip(sockets, ('first', 'second')))
    if constant is not None and constant <= 0.0:
        roles = roles[:1]
    elif constant is not None and constant >= 1.0:
        roles = roles[1:]
    return [(resolve(use.scope, socket), role) for socket, role in roles]


def order_shaders(compiler, root):
    """Return [(use, source, children)] under `root`, users before what they use.

    Links that would close a loop are dropped. `children` are [(key, role)] and `key` is how a later
    entry's use is named: (path, node pointer).
    """
    done, open_nodes, order = {}, set(), []

    def visit(source):
        if source.node is None:
            return None
        key = (source.scope.path, source.node.as_pointer())
        if key in open_nodes:
            return None
        if key in done:
            return key
        open_nodes.add(key)
        use = NodeUse(compiler, source.node, source.scope)
        children = []
        for child, role in _children(compiler, use):
            child_key = visit(child)
            if child_key is not None:
                children.append((child_key, role))
        open_nodes.discard(key)
        done[key] = True
        order.append((key, use, source, children))
        return key

    visit(root)
    order.reverse()
    return order


def write_surface(compiler, root):
    """Write the closures of a material's surface, whose `Source` is `root`."""
    weights = {}
    varying = set()
    order = order_shaders(compiler, root)
    if order:
        weights[order[0][0]] = ['vec3(1.0)']
    for key, use, source, children in order:
        weight = _sum(compiler, weights.get(key, ()))
        if weight is None:
            continue
        if children or use.node.type in ('MIX_SHADER', 'ADD_SHADER'):
            factor = mix_factor(use) if any(role != 'same' for _, role in children) else None
            for child, role in children:
                weights.setdefault(child, []).append(_scaled(weight, factor, role))
                if key in varying or (role != 'same' and factor.constant is None):
                    varying.add(child)
        else:
            compiler.weight_varies = key in varying
            _write_closure(compiler, use, source, weight)


def _sum(compiler, parts):
    if not parts:
        return None
    if len(parts) == 1 and parts[0] == 'vec3(1.0)':
        return parts[0]
    return compiler.declare('color', ' + '.join(parts)).code


def _scaled(weight, factor, role):
    if role == 'same' or factor.constant == (0.0 if role == 'first' else 1.0):
        return weight
    return f'{weight} * {factor.code}' if role == 'second' else f'{weight} * (1.0 - {factor.code})'


def _write_closure(compiler, use, source, weight):
    if socket_kind(source.socket) != 'shader':
        # A colour linked straight into a shader socket shines with that colour.
        value = convert(compiler.source_value(source._replace(kinds=('color',))), 'color')
        compiler.note_emission(value)
        _emit(compiler, weight, value.code)
        return
    writer = CLOSURES.get(use.node.type)
    if writer is not None:
        writer(use, weight)
        return
    substitute = _SUBSTITUTES.get(use.node.type)
    if substitute is None:
        compiler.warn(use.node, 'black')
        return
    name, writer = substitute
    compiler.warn(use.node, f'a {name}')
    writer(use, weight)


def _emit(compiler, weight, radiance):
    compiler.statement(f'closure_emission(surface, {weight}, {radiance});')


def is_black(use, color, strength):
    """Tell whether an emission is known to be zero: by its colour or by its strength."""
    if use.constant(strength) == 0.0:
        return True
    constant = use.constant(color)
    return constant is not None and not any(constant)


def _color(use, name='Color'):
    return use.get(name, 'color') if use.has_input(name) else 'vec3(0.8)'


def _float(use, name, otherwise):
    return use.get(name, 'float') if use.has_input(name) else otherwise


def _roughness(use):
    """Roughness of a closure; the distribution 'Sharp' of old files means none."""
    if getattr(use.node, 'distribution', '') == 'SHARP':
        return '0.0'
    return _float(use, 'Roughness', '0.0')


def _note_glossy(use):
    sharp = getattr(use.node, 'distribution', '') == 'SHARP'
    use.compiler.note_glossy(0.0 if sharp else use.constant('Roughness'))


def is_multiscatter(use):
    """Tell whether light is to be scattered several times between the facets of a closure."""
    return getattr(use.node, 'distribution', '') == 'MULTI_GGX'


@closure('BSDF_DIFFUSE')
def diffuse(use, weight):
    """Diffuse BSDF."""
    use.compiler.statement(
        f'closure_diffuse(surface, {weight}, {_color(use)}, {_float(use, "Roughness", "0.0")}, '
        f'{use.normal()});')


@closure('BSDF_GLOSSY')
def glossy(use, weight):
    """Glossy BSDF."""
    _note_glossy(use)
    if getattr(use.node, 'distribution', '') in ('BECKMANN', 'ASHIKHMIN_SHIRLEY'):
        use.compiler.warn(use.node, 'GGX', 'has one distribution only')
    function = 'closure_glossy(surface'
    if is_multiscatter(use):
        function = 'closure_glossy_multiscatter(hit, surface'
    use.compiler.statement(
        f'{function}, {weight}, {_color(use)}, {_roughness(use)}, {use.normal()});')


def _refractive(use, weight, function):
    use.compiler.facts['transmission'] = True
    use.compiler.statement(
        f'{function}(hit, surface, {weight}, {_color(use)}, {_roughness(use)}, '
        f'{_float(use, "IOR", "1.5")}, {use.normal()});')


@closure('BSDF_GLASS')
def glass(use, weight):
    """Glass BSDF."""
    _note_glossy(use)
    _refractive(use, weight,
                'closure_glass_multiscatter' if is_multiscatter(use) else 'closure_glass')


@closure('BSDF_REFRACTION')
def refraction(use, weight):
    """Refraction BSDF."""
    _refractive(use, weight, 'closure_refraction')


@closure('BSDF_VELVET', 'BSDF_SHEEN')
def velvet(use, weight):
    """Velvet BSDF (Sheen BSDF from 4.0 on): Ashikhmin's lobe."""
    compiler = use.compiler
    compiler.facts['layers'] = True
    if getattr(use.node, 'distribution', 'ASHIKHMIN') != 'ASHIKHMIN':
        compiler.warn(use.node, "Ashikhmin's", 'has no microfiber distribution yet')
    sigma = _float(use, 'Sigma' if use.has_input('Sigma') else 'Roughness', '1.0')
    compiler.statement(
        f'closure_velvet(surface, {weight}, {_color(use)}, {sigma}, {use.normal()});')


@closure('BSDF_TRANSPARENT')
def transparent(use, weight):
    """Transparent BSDF."""
    use.compiler.facts['alpha'] = True
    use.compiler.statement(f'closure_transparent(surface, {weight}, {_color(use)});')


@closure('EMISSION', 'BACKGROUND')
def emission(use, weight):
    """Emission node (a Background linked to a surface shines as well)."""
    if is_black(use, 'Color', 'Strength'):
        return
    color, strength = convert(use.value('Color'), 'color'), convert(use.value('Strength'), 'float')
    use.compiler.note_emission(color, strength)
    _emit(use.compiler, weight, f'{color.code} * {strength.code}')


@closure('MIX_SHADER', 'ADD_SHADER')
def empty_mix(use, weight):
    """A mix without any shader linked: black."""


def _metallic(use, weight):
    """Metallic BSDF of 4.3 and later, by its base colour."""
    _note_glossy(use)
    use.compiler.statement(
        f'closure_glossy(surface, {weight}, {_color(use, "Base Color")}, {_roughness(use)}, '
        f'{use.normal()});')


def _eevee_specular(use, weight):
    """EEVEE's Specular BSDF: a diffuse layer."""
    use.compiler.statement(
        f'closure_diffuse(surface, {weight}, {_color(use, "Base Color")}, 0.0, {use.normal()});')


_SUBSTITUTES = {
    'SUBSURFACE_SCATTERING': ('Diffuse BSDF', diffuse),
    'BSDF_TRANSLUCENT': ('Diffuse BSDF', diffuse),
    'BSDF_TOON': ('Diffuse BSDF', diffuse),
    'BSDF_HAIR': ('Diffuse BSDF', diffuse),
    'BSDF_HAIR_PRINCIPLED': ('Diffuse BSDF', diffuse),
    'BSDF_ANISOTROPIC': ('Glossy BSDF', glossy),
    'BSDF_METALLIC': ('Glossy BSDF', _metallic),
    'EEVEE_SPECULAR': ('Diffuse BSDF', _eevee_specular),
    'BSDF_RAY_PORTAL': ('Transparent BSDF', transparent),
}
