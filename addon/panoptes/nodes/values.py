# SPDX-License-Identifier: GPL-3.0-or-later
"""Values that flow through a node tree, as GLSL expressions with Blender's socket conversions.

A `Value` is an expression of one of three kinds: 'float', 'color' and 'vector'. The last two are
both a GLSL vec3, but turn into a float differently: a colour by its Rec.709 luminance, a vector by
the mean of its components. `constant` holds the numbers themselves when they are known without
running the shader: a float, or a tuple of three.
"""

from typing import NamedTuple, Optional, Tuple, Union

LUMINANCE = (0.2126729, 0.7151522, 0.0721750)

# Kinds by Blender's socket types. Anything else that carries a value is read as a float.
_SOCKET_KINDS = {
    'VALUE': 'float',
    'INT': 'float',
    'BOOLEAN': 'float',
    'RGBA': 'color',
    'VECTOR': 'vector',
    'ROTATION': 'vector',
    'SHADER': 'shader',
}

Number = Union[float, Tuple[float, float, float]]


class Value(NamedTuple):
    """An expression, its kind and, where known, its numbers."""

    kind: str
    code: str
    constant: Optional[Number] = None


def socket_kind(socket):
    """Return 'float', 'color', 'vector' or 'shader' for a Blender node socket."""
    return _SOCKET_KINDS.get(socket.type, 'float')


def convert_number(number, source, target):
    """Convert a constant of kind `source` as a link between two sockets of these kinds does."""
    if source == 'float':
        return number if target == 'float' else (number, number, number)
    if target != 'float':
        return number
    weights = LUMINANCE if source == 'color' else (1 / 3, 1 / 3, 1 / 3)
    return sum(w * c for w, c in zip(weights, number))


def convert(value, kind):
    """Return `value` as `kind` ('float', 'color' or 'vector')."""
    if value.kind == kind:
        return value
    constant = None
    if value.constant is not None:
        constant = convert_number(value.constant, value.kind, kind)
    if value.kind == 'float':
        return Value(kind, f'vec3({value.code})', constant)
    if kind != 'float':
        return Value(kind, value.code, constant)
    if value.kind == 'color':
        weights = ', '.join(f'{w:.7f}' for w in LUMINANCE)
        return Value(kind, f'dot({value.code}, vec3({weights}))', constant)
    return Value(kind, f'(dot({value.code}, vec3(1.0)) * (1.0 / 3.0))', constant)


def socket_number(socket):
    """Return an unlinked input socket's own value: a float, or a tuple of three."""
    number = getattr(socket, 'default_value', 0.0)
    kind = socket_kind(socket)
    if kind == 'float':
        try:
            return float(number)
        except (TypeError, ValueError):
            return 0.0
    try:
        return tuple(float(c) for c in number)[:3]
    except TypeError:
        return (0.0, 0.0, 0.0)


class ParameterBlock:
    """The vec4 block that holds every value of a shader, so that the code itself holds none.

    Scalars fill the components that vectors leave free, in the order of the requests: the layout
    depends on the structure of the tree alone, never on its values.
    """

    def __init__(self):
        self.rows = []
        self._spare = []

    def scalar(self, number):
        """Store a float; return the GLSL expression that reads it."""
        if not self._spare:
            row = self._append((0.0, 0.0, 0.0, 0.0))
            self._spare = [(row, 0), (row, 1), (row, 2), (row, 3)]
        row, component = self._spare.pop(0)
        self.rows[row][component] = float(number)
        return f'param({row}).{"xyzw"[component]}'

    def vector(self, numbers):
        """Store three floats; return the GLSL expression (a vec3) that reads them."""
        row = self._append((*numbers, 0.0))
        self._spare.append((row, 3))
        return f'param({row}).xyz'

    def table(self, rows):
        """Store consecutive rows of four floats; return the index of the first."""
        first = len(self.rows)
        for row in rows:
            self._append(row)
        return first

    def _append(self, row):
        self.rows.append([float(c) for c in row])
        return len(self.rows) - 1
