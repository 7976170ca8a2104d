# SPDX-License-Identifier: GPL-3.0-or-later
"""Converter nodes: Math, Vector Math, Map Range, Clamp, Color Ramp, curves, Separate and Combine."""

from .compiler import value_node
from .values import Value

# Math operations as expressions of a, b and c. A name in brackets is a helper function.
_MATH = {
    'ADD': '{a} + {b}',
    'SUBTRACT': '{a} - {b}',
    'MULTIPLY': '{a} * {b}',
    'DIVIDE': '[node_divide]({a}, {b})',
    'MULTIPLY_ADD': '{a} * {b} + {c}',
    'POWER': '[node_power]({a}, {b})',
    'LOGARITHM': '[node_logarithm]({a}, {b})',
    'SQRT': 'sqrt(max({a}, 0.0))',
    'INVERSE_SQRT': '({a} > 0.0 ? inversesqrt({a}) : 0.0)',
    'ABSOLUTE': 'abs({a})',
    'EXPONENT': 'exp({a})',
    'MINIMUM': 'min({a}, {b})',
    'MAXIMUM': 'max({a}, {b})',
    'LESS_THAN': '({a} < {b} ? 1.0 : 0.0)',
    'GREATER_THAN': '({a} > {b} ? 1.0 : 0.0)',
    'SIGN': 'sign({a})',
    'COMPARE': '(abs({a} - {b}) <= max({c}, 1e-5) ? 1.0 : 0.0)',
    'SMOOTH_MIN': '[node_smooth_minimum]({a}, {b}, {c})',
    'SMOOTH_MAX': '-[node_smooth_minimum](-({a}), -({b}), {c})',
    'ROUND': 'floor({a} + 0.5)',
    'FLOOR': 'floor({a})',
    'CEIL': 'ceil({a})',
    'TRUNC': 'trunc({a})',
    'FRACT': 'fract({a})',
    'MODULO': '[node_modulo]({a}, {b})',
    'FLOORED_MODULO': '[node_floored_modulo]({a}, {b})',
    'WRAP': '[node_wrap]({a}, {b}, {c})',
    'SNAP': 'floor([node_divide]({a}, {b})) * {b}',
    'PINGPONG': '[node_ping_pong]({a}, {b})',
    'SINE': 'sin({a})',
    'COSINE': 'cos({a})',
    'TANGENT': 'tan({a})',
    'ARCSINE': 'asin(clamp({a}, -1.0, 1.0))',
    'ARCCOSINE': 'acos(clamp({a}, -1.0, 1.0))',
    'ARCTANGENT': 'atan({a})',
    'ARCTAN2': '(({a} == 0.0 && {b} == 0.0) ? 0.0 : atan({a}, {b}))',
    'SINH': 'sinh({a})',
    'COSH': 'cosh({a})',
    'TANH': 'tanh({a})',
    'RADIANS': 'radians({a})',
    'DEGREES': 'degrees({a})',
}

# Vector Math operations that give a vector; each component alone where the text says `component`.
_VECTOR_MATH = {
    'ADD': '{a} + {b}',
    'SUBTRACT': '{a} - {b}',
    'MULTIPLY': '{a} * {b}',
    'DIVIDE': '[node_divide]({a}, {b})',
    'MULTIPLY_ADD': '{a} * {b} + {c}',
    'CROSS_PRODUCT': 'cross({a}, {b})',
    'PROJECT': '[node_project]({a}, {b})',
    'REFLECT': 'reflect({a}, [node_safe_normalize]({b}))',
    'REFRACT': 'refract({a}, [node_safe_normalize]({b}), {scale})',
    'FACEFORWARD': 'faceforward({a}, {b}, {c})',
    'SCALE': '{a} * {scale}',
    'NORMALIZE': '[node_safe_normalize]({a})',
    'ABSOLUTE': 'abs({a})',
    'SIGN': 'sign({a})',
    'MINIMUM': 'min({a}, {b})',
    'MAXIMUM': 'max({a}, {b})',
    'ROUND': 'floor({a} + 0.5)',
    'FLOOR': 'floor({a})',
    'CEIL': 'ceil({a})',
    'FRACTION': 'fract({a})',
    'SNAP': 'floor([node_divide]({a}, {b})) * {b}',
    'SINE': 'sin({a})',
    'COSINE': 'cos({a})',
    'TANGENT': 'tan({a})',
}
_VECTOR_MATH_BY_COMPONENT = {
    'POWER': ('node_power', 'ab'),
    'MODULO': ('node_modulo', 'ab'),
    'WRAP': ('node_wrap', 'abc'),
}
_VECTOR_MATH_SCALAR = {
    'DOT_PRODUCT': 'dot({a}, {b})',
    'DISTANCE': 'distance({a}, {b})',
    'LENGTH': 'length({a})',
}

# Cycles bakes ramps and curves to tables of this size.
_TABLE_SIZE = 256


def _fill(compiler, template, arguments):
    """Insert operands into a template and pull in the helpers that it names."""
    while '[' in template:
        start, rest = template.split('[', 1)
        name, end = rest.split(']', 1)
        template = start + compiler.helper(name) + end
    return template.format(**arguments)


def _operands(use, kind, template):
    """Return the operands a, b, c that a template reads, each in a variable or a parameter."""
    names = [socket for socket in use.node.inputs if socket.name != 'Scale']
    found = {}
    for letter, socket in zip('abc', names):
        if '{' + letter + '}' in template:
            found[letter] = f'({use.get(socket.identifier, kind)})'
    if '{scale}' in template:
        found['scale'] = f'({use.get("Scale", "float")})'
    return found


@value_node('MATH')
def math(use, output):
    """Math node, every operation."""
    template = _MATH.get(use.node.operation)
    if template is None:
        use.compiler.warn(use.node, 'its first input',
                          f'has no operation {use.node.operation.title()} yet')
        template = '{a}'
    code = _fill(use.compiler, template, _operands(use, 'float', template))
    if use.node.use_clamp:
        code = f'clamp({code}, 0.0, 1.0)'
    return use.declare('float', code)


@value_node('VECT_MATH')
def vector_math(use, output):
    """Vector Math node."""
    compiler, operation = use.compiler, use.node.operation
    if operation in _VECTOR_MATH_SCALAR:
        if output != 'Value':
            return Value('vector', 'vec3(0.0)', (0.0, 0.0, 0.0))
        template = _VECTOR_MATH_SCALAR[operation]
        code = _fill(compiler, template, _operands(use, 'vector', template))
        return use.declare('float', code)
    if output == 'Value':
        return Value('float', '0.0', 0.0)
    if operation in _VECTOR_MATH_BY_COMPONENT:
        function, letters = _VECTOR_MATH_BY_COMPONENT[operation]
        found = _operands(use, 'vector', ''.join('{%s}' % letter for letter in letters))
        calls = (', '.join(f'{found[letter]}.{axis}' for letter in letters) for axis in 'xyz')
        function = compiler.helper(function)
        return use.declare('vector', 'vec3(' + ', '.join(f'{function}({c})' for c in calls) + ')')
    template = _VECTOR_MATH.get(operation)
    if template is None:
        compiler.warn(use.node, 'its first input', f'has no operation {operation.title()} yet')
        template = '{a}'
    return use.declare('vector', _fill(compiler, template, _operands(use, 'vector', template)))


@value_node('MAP_RANGE')
def map_range(use, output):
    """Map Range node for floats and vectors, all four interpolations."""
    compiler, node = use.compiler, use.node
    vectors = node.data_type == 'FLOAT_VECTOR'
    kind = 'vector' if vectors else 'float'
    if (output == 'Vector') != vectors:
        kind = 'vector' if output == 'Vector' else 'float'
        return compiler.parameter(kind, 0.0 if kind == 'float' else (0.0, 0.0, 0.0))
    suffix = '_FLOAT3' if vectors else ''

    def get(name):
        identifier = name.replace(' ', '_') + suffix if vectors else name
        return use.declare(kind, use.get(identifier, kind)).code

    number = use.declare(kind, use.get('Vector' if vectors else 'Value', kind)).code
    from_low, from_high = get('From Min'), get('From Max')
    to_low, to_high = get('To Min'), get('To Max')
    divide = compiler.helper('node_divide')
    factor = f'{divide}({number} - {from_low}, {from_high} - {from_low})'
    interpolation = node.interpolation_type
    if interpolation == 'STEPPED':
        steps = get('Steps')
        factor = f'{divide}(floor({factor} * ({steps} + 1.0)), {steps})'
    elif interpolation in ('SMOOTHSTEP', 'SMOOTHERSTEP'):
        t = use.declare(kind, f'clamp({factor}, 0.0, 1.0)').code
        if interpolation == 'SMOOTHSTEP':
            factor = f'({t} * {t} * (3.0 - 2.0 * {t}))'
        else:
            factor = f'({t} * {t} * {t} * ({t} * ({t} * 6.0 - 15.0) + 10.0))'
    result = f'{to_low} + {factor} * ({to_high} - {to_low})'
    if node.clamp and interpolation in ('LINEAR', 'STEPPED'):
        result = f'clamp({result}, min({to_low}, {to_high}), max({to_low}, {to_high}))'
    return use.declare(kind, result)


@value_node('CLAMP')
def clamp(use, output):
    """Clamp node."""
    number = use.get('Value', 'float')
    low = use.declare('float', use.get('Min', 'float')).code
    high = use.declare('float', use.get('Max', 'float')).code
    if use.node.clamp_type == 'RANGE':
        low, high = f'min({low}, {high})', f'max({low}, {high})'
    # min(max()) keeps the answer defined where the minimum exceeds the maximum.
    return use.declare('float', f'min(max({number}, {low}), {high})')


def _table_lookup(use, rows, position, interpolate=True, extrapolate=False):
    """Return a vec4 variable: the table `rows` (a list of 4 floats each) read at 0..1."""
    compiler = use.compiler
    first = compiler.parameters.table(rows)
    function = compiler.helper('node_extended_table' if extrapolate else 'node_table')
    flag = 'true' if interpolate else 'false'
    return compiler.declare_vec4(
        f'{function}({first}, {len(rows) - 1}, {position}, {flag})')


@value_node('VALTORGB')
def color_ramp(use, output):
    """Color Ramp node as a table, so that moving a stop never changes the code."""
    ramp = use.node.color_ramp

    def create():
        rows = [ramp.evaluate(i / (_TABLE_SIZE - 1))[:] for i in range(_TABLE_SIZE)]
        return _table_lookup(use, rows, use.get('Fac', 'float'), ramp.interpolation != 'CONSTANT')

    variable = use.compiler.shared(('ramp', use.scope.path, use.node.as_pointer()), create)
    return Value('float', f'{variable}.w') if output == 'Alpha' else Value('color', f'{variable}.xyz')


def _curve_range(mapping, count):
    """Return the range of positions that the points of the first `count` curves span."""
    points = [p.location.x for curve in list(mapping.curves)[:count] for p in curve.points]
    return min(points), max(points)


def _curve_lookup(use, count, curves, inner=None):
    """Return a function (position expression) -> vec4 variable, of up to four curves in a table.

    `count` curves span the table; every curve is applied to what the curve `inner` gives.
    """
    mapping = use.node.mapping
    mapping.initialize()
    low, high = _curve_range(mapping, count)
    high = max(high, low + 1e-6)
    rows = []
    for i in range(_TABLE_SIZE):
        position = low + i * (high - low) / (_TABLE_SIZE - 1)
        if inner is not None:
            position = mapping.evaluate(inner, position)
        samples = [mapping.evaluate(curve, position) for curve in curves]
        rows.append((*samples, *([0.0] * (4 - len(samples)))))
    start = use.compiler.parameter('float', low).code
    scale = use.compiler.parameter('float', 1.0 / (high - low)).code
    extrapolate = mapping.extend == 'EXTRAPOLATED'
    return lambda place: _table_lookup(use, rows, f'({place} - {start}) * {scale}',
                                       extrapolate=extrapolate)


@value_node('CURVE_RGB', 'CURVE_VEC')
def curves(use, output):
    """RGB Curves and Vector Curves nodes; of colours the combined curve comes first."""
    colors = use.node.type == 'CURVE_RGB'
    kind = 'color' if colors else 'vector'
    found = list(use.node.mapping.curves)
    source = use.declare(kind, use.get('Color' if colors else 'Vector', kind)).code
    lookup = _curve_lookup(use, 4 if colors else 3, found[:3], found[3] if colors else None)
    parts = ', '.join(f'{lookup(f"{source}.{axis}")}.{axis}' for axis in 'xyz')
    return use.declare(kind, f'mix({source}, vec3({parts}), {use.get("Fac", "float")})')


@value_node('CURVE_FLOAT')
def float_curve(use, output):
    """Float Curve node."""
    source = use.declare('float', use.get('Value', 'float')).code
    lookup = _curve_lookup(use, 1, [use.node.mapping.curves[0]])
    return use.declare('float', f'mix({source}, {lookup(source)}.x, {use.get("Factor", "float")})')


@value_node('SEPARATE_COLOR', 'SEPRGB', 'SEPHSV', 'SEPXYZ')
def separate(use, output):
    """Separate Color, XYZ and the older Separate RGB and HSV."""
    node = use.node
    mode = getattr(node, 'mode', 'HSV' if node.type == 'SEPHSV' else 'RGB')
    name, kind = ('Vector', 'vector') if node.type == 'SEPXYZ' else (node.inputs[0].identifier,
                                                                    'color')

    def create():
        code = use.get(name, kind)
        if mode in ('HSV', 'HSL'):
            code = f'{use.compiler.helper("node_rgb_to_" + mode.lower())}({code})'
        return use.declare(kind, code).code

    key = ('separate', use.scope.path, node.as_pointer())
    index = [socket.identifier for socket in node.outputs].index(output)
    return Value('float', f'{use.compiler.shared(key, create)}.{"xyz"[index]}')


@value_node('COMBINE_COLOR', 'COMBRGB', 'COMBHSV', 'COMBXYZ')
def combine(use, output):
    """Combine Color, XYZ and the older Combine RGB and HSV."""
    node = use.node
    mode = getattr(node, 'mode', 'HSV' if node.type == 'COMBHSV' else 'RGB')
    parts = ', '.join(use.get(socket.identifier, 'float') for socket in list(node.inputs)[:3])
    code = f'vec3({parts})'
    if mode in ('HSV', 'HSL'):
        code = f'{use.compiler.helper(f"node_{mode.lower()}_to_rgb")}({code})'
    return use.declare('vector' if node.type == 'COMBXYZ' else 'color', code)
