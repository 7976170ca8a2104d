# SPDX-License-Identifier: GPL-3.0-or-later
"""Noise, White Noise, Musgrave, Voronoi, Wave, Magic and Brick Texture."""

from . import noise_helpers, voronoi_helpers  # noqa: F401 (register the GLSL)
from .compiler import value_node
from .images import mapped
from .values import Value

_DIMENSIONS = {'1D': 1, '2D': 2, '3D': 3, '4D': 4}


def _place(use, scaled=True):
    """Return (vec4 variable of the place, number of its components that count)."""
    count = _DIMENSIONS[getattr(use.node, dimensions_property(use.node), '3D')]
    scale = f' * {use.get("Scale", "float")}' if scaled else ''
    if count == 1:
        code = f'vec4({use.get("W", "float")}, 0.0, 0.0, 0.0)'
    else:
        vector = mapped(use)
        code = {2: f'vec4({vector}.xy, 0.0, 0.0)', 3: f'vec4({vector}, 0.0)'}.get(count)
        code = code or f'vec4({vector}, {use.get("W", "float")})'
    return use.compiler.declare_vec4(code + scale), count


def dimensions_property(node):
    """Return the name of the property that holds a texture's number of dimensions."""
    return next((name for name in ('noise_dimensions', 'musgrave_dimensions', 'voronoi_dimensions')
                 if hasattr(node, name)), '')


def _float(use, name, otherwise):
    return use.get(name, 'float') if use.has_input(name) else otherwise


def _shared(use, create):
    """Compute a texture once for all of its outputs."""
    return use.compiler.shared(('noise', use.scope.path, use.node.as_pointer()), create)


@value_node('TEX_NOISE')
def noise(use, output):
    """Noise Texture node; of the fractals that 4.1 added, the plain one."""
    compiler = use.compiler
    if getattr(use.node, 'noise_type', 'FBM') != 'FBM' or not getattr(use.node, 'normalize', True):
        compiler.warn(use.node, 'a normalised fBM', 'has one kind of noise only')
    compiler.helper('noise_fractal')

    def create():
        place, count = _place(use)
        distortion = _float(use, 'Distortion', '0.0')
        return compiler.declare_vec4(f'noise_distorted({place}, {count}, {distortion})'), count

    place, count = _shared(use, create)
    arguments = ', '.join((place, str(count), use.get('Detail', 'float'),
                           _float(use, 'Roughness', '0.5'), _float(use, 'Lacunarity', '2.0')))
    if output == 'Color':
        return use.declare('color', f'noise_fractal_color({arguments})')
    return use.declare('float', f'noise_fractal({arguments})')


@value_node('TEX_WHITE_NOISE')
def white_noise(use, output):
    """White Noise Texture node."""
    use.compiler.helper('noise_hash')
    place, count = _shared(use, lambda: _place(use, scaled=False))
    if output == 'Color':
        return use.declare('color', f'noise_random_color({place}, {count})')
    return use.declare('float', f'noise_random({place}, {count})')


@value_node('TEX_MUSGRAVE')
def musgrave(use, output):
    """Musgrave Texture node (until 4.0)."""
    use.compiler.helper('noise_musgrave')
    place, count = _place(use)
    names = ('Detail', 'Dimension', 'Lacunarity', 'Offset', 'Gain')
    numbers = ', '.join(_float(use, name, '0.0') for name in names)
    kind = f'MUSGRAVE_{use.node.musgrave_type}'
    return use.declare('float', f'noise_musgrave({kind}, {place}, {count}, {numbers})')


@value_node('TEX_VORONOI')
def voronoi(use, output):
    """Voronoi Texture node; without the fractal sums that 4.0 added."""
    compiler, node = use.compiler, use.node
    if use.has_input('Detail') and use.constant('Detail') != 0.0:
        compiler.warn(node, 'its coarsest cells', 'has no detail yet')
    feature, randomness = node.feature, f'clamp({use.get("Randomness", "float")}, 0.0, 1.0)'
    if feature in ('DISTANCE_TO_EDGE', 'N_SPHERE_RADIUS'):
        if output not in ('Distance', 'Radius'):
            return compiler.parameter('vector', (0.0, 0.0, 0.0))
        function = 'edge' if feature == 'DISTANCE_TO_EDGE' else 'radius'
        compiler.helper(f'noise_voronoi_{function}')
        place, count = _place(use)
        return use.declare('float', f'voronoi_{function}({place}, {count}, {randomness})')

    def create():
        place, count = _place(use)
        exponent = _float(use, 'Exponent', '0.5')
        arguments = f'{place}, {count}, METRIC_{node.distance}, {exponent}, {randomness}'
        if feature == 'SMOOTH_F1':
            compiler.helper('noise_voronoi_smooth')
            smoothness = f'max(0.5 * clamp({use.get("Smoothness", "float")}, 0.0, 1.0), 1e-6)'
            call = f'voronoi_smooth({arguments}, {smoothness})'
        else:
            compiler.helper('noise_voronoi_nearest')
            call = f'voronoi_nearest({arguments}, {"true" if feature == "F2" else "false"})'
        name = f'v{compiler.take_number()}'
        compiler.statement(f'Voronoi {name} = {call};')
        return name

    found = _shared(use, create)
    if output == 'Distance':
        return Value('float', f'{found}.distance')
    if output == 'Color':
        return Value('color', f'{found}.color')
    divide = compiler.helper('node_divide')
    scale = use.get('Scale', 'float')
    if output == 'W':
        component = 'x' if node.voronoi_dimensions == '1D' else 'w'
        return use.declare('float', f'{divide}({found}.place.{component}, {scale})')
    return use.declare('vector', f'{divide}({found}.place.xyz, vec3({scale}))')


_WAVES = {
    ('BANDS', 'X'): '20.0 * {p}.x', ('BANDS', 'Y'): '20.0 * {p}.y', ('BANDS', 'Z'): '20.0 * {p}.z',
    ('BANDS', 'DIAGONAL'): '10.0 * ({p}.x + {p}.y + {p}.z)', ('RINGS', 'X'): '20.0 * length({p}.yz)',
    ('RINGS', 'Y'): '20.0 * length({p}.xz)', ('RINGS', 'Z'): '20.0 * length({p}.xy)',
    ('RINGS', 'SPHERICAL'): '20.0 * length({p})',
}
_PROFILES = {
    'SIN': '0.5 + 0.5 * sin({n} - 1.57079633)', 'SAW': 'fract({n} * 0.159154943)',
    'TRI': '2.0 * abs({n} * 0.159154943 - floor({n} * 0.159154943 + 0.5))',
}


@value_node('TEX_WAVE')
def wave(use, output):
    """Wave Texture node."""
    compiler, node = use.compiler, use.node

    def create():
        # A plane exactly on a border must not flicker.
        place = f'({mapped(use)} * {use.get("Scale", "float")} + 0.000001) * 0.999999'
        place = use.declare('vector', place).code
        direction = node.bands_direction if node.wave_type == 'BANDS' else node.rings_direction
        phase = _WAVES[node.wave_type, direction].format(p=place)
        phase += f' + {use.get("Phase Offset", "float")}'
        if use.constant('Distortion') != 0.0:
            compiler.helper('noise_fractal')
            finer = f'vec4({place} * {use.get("Detail Scale", "float")}, 0.0)'
            numbers = f'{use.get("Detail", "float")}, {use.get("Detail Roughness", "float")}, 2.0'
            phase += (f' + {use.get("Distortion", "float")} * '
                      f'(2.0 * noise_fractal({finer}, 3, {numbers}) - 1.0)')
        phase = use.declare('float', phase).code
        return use.declare('float', _PROFILES[node.wave_profile].format(n=phase)).code

    factor = _shared(use, create)
    return Value('float', factor) if output == 'Fac' else Value('color', f'vec3({factor})')


@value_node('TEX_MAGIC')
def magic(use, output):
    """Magic Texture node."""

    def create():
        function = use.compiler.helper('noise_magic')
        return use.declare('color', f'{function}({mapped(use)} * {use.get("Scale", "float")}, '
                                    f'{use.node.turbulence_depth}, {use.get("Distortion", "float")})').code

    color = _shared(use, create)
    if output == 'Fac':
        return use.declare('float', f'dot({color}, vec3(1.0 / 3.0))')
    return Value('color', color)


@value_node('TEX_BRICK')
def brick(use, output):
    """Brick Texture node."""
    compiler, node = use.compiler, use.node

    def create():
        function = compiler.helper('noise_brick')
        sockets = ('Mortar Size', 'Mortar Smooth', 'Bias', 'Brick Width', 'Row Height')
        numbers = ', '.join(use.get(name, 'float') for name in sockets)
        offset = compiler.parameter('float', node.offset).code
        squash = compiler.parameter('float', node.squash).code
        place = f'{mapped(use)} * {use.get("Scale", "float")}'
        name = f'v{compiler.take_number()}'
        compiler.statement(
            f'vec2 {name} = {function}({place}, {numbers}, {offset}, {node.offset_frequency}, '
            f'{squash}, {node.squash_frequency});')
        return name

    found = _shared(use, create)
    if output == 'Fac':
        return Value('float', f'{found}.y')
    colors = [use.get(name, 'color') for name in ('Color1', 'Color2', 'Mortar')]
    return use.declare('color', f'mix(mix({colors[0]}, {colors[1]}, {found}.x), {colors[2]}, {found}.y)')
