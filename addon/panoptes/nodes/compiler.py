# SPDX-License-Identifier: GPL-3.0-or-later
"""The compiler proper: one tree in, straight-line GLSL and a parameter block out.

Every node output becomes one GLSL variable, written once. Values never enter the code: they go to
the parameter block, so that trees of the same structure give the same text and share a program, and
dragging a slider is an upload. A value decides about the code only where a term vanishes with it
(an emission of strength 0 costs nothing because it is not there).

Handlers of value nodes are registered by `value_node(TYPE)`; they get a `NodeUse` and the name
(identifier) of the wanted output and return a `Value`.
"""

import contextlib
import sys

from .. import compat
from . import helpers
from .scope import resolve
from .values import ParameterBlock, Value, convert, convert_number, socket_kind, socket_number

VALUE_NODES = {}

# The mesh attribute that holds positions before deformation; no artist's own begins with a dot.
UNDEFORMED = '.undeformed'
# Deeper chains than this are met in generated trees only; Python's own limit is about 300 nodes.
_RECURSION_LIMIT = 20000


def value_node(*types):
    """Register a function (node use, output identifier) -> Value for these node types."""

    def register(function):
        for node_type in types:
            VALUE_NODES[node_type] = function
        return function

    return register


@contextlib.contextmanager
def deep_recursion():
    """Let long chains of nodes be followed recursively."""
    limit = sys.getrecursionlimit()
    sys.setrecursionlimit(max(limit, _RECURSION_LIMIT))
    try:
        yield
    finally:
        sys.setrecursionlimit(limit)


class NodeUse:
    """A node as seen through the groups that lead to it; what handlers work with."""

    def __init__(self, compiler, node, scope):
        self.compiler = compiler
        self.node = node
        self.scope = scope

    def has_input(self, name):
        """Tell whether the node has an input of this identifier or name."""
        return compat.find_socket(self.node.inputs, name) is not None

    def source(self, name):
        """Return the `Source` of an input, or None where the node has no such input."""
        socket = compat.find_socket(self.node.inputs, name)
        return None if socket is None else resolve(self.scope, socket)

    def is_linked(self, name):
        """Tell whether another node feeds this input."""
        source = self.source(name)
        return source is not None and source.node is not None

    def constant(self, name):
        """Return the number(s) of an input that no node feeds, else None."""
        source = self.source(name)
        if source is None or source.node is not None:
            return None
        return self.compiler.source_number(source)

    def value(self, name):
        """Return the `Value` that arrives at an input, in the kind of the input socket."""
        source = self.source(name)
        if source is None:
            return Value('float', '0.0', 0.0)
        return self.compiler.source_value(source)

    def get(self, name, kind):
        """Return the GLSL expression of an input as 'float', 'color' or 'vector'."""
        return convert(self.value(name), kind).code

    def output_used(self, name):
        """Tell whether an output is linked to anything in its tree."""
        socket = compat.find_socket(self.node.outputs, name)
        return socket is not None and self.scope.is_used(socket)

    def normal(self, name='Normal'):
        """Return the expression of a normal input; unlinked, it is the shading normal."""
        if self.is_linked(name):
            return self.get(name, 'vector')
        return self.compiler.shading_normal()

    def declare(self, kind, expression):
        """Give an expression a variable of its own."""
        return self.compiler.declare(kind, expression)


class Compiler:
    """State of one compilation.

    `domain` is 'material' or 'world'; `owner` is how warnings name the data-block
    ("Material 'Oak'"), `pass_index` its number for the Object Info node. Afterwards: `lines`, `functions` (texts of functions of a hit),
    `helpers`, `parameters.rows`, `textures` (image, interpolation, extension, image user), `attributes` (names), `facts`,
    `least_roughness` (of all that reflects, as far as it is known), `warnings`.
    """

    def __init__(self, domain, owner, pass_index=0):
        self.domain = domain
        self.owner = owner
        self.pass_index = pass_index
        self.parameters = ParameterBlock()
        self.lines = []
        self.functions = []
        self.helpers = []
        # What shading_normal() answers in a material.
        self.normal = 'hit.normal'
        self.textures = []
        self.attributes = []
        self.facts = {'alpha': False, 'emission': False, 'emission_varies': False,
                      'normal_map': False, 'glossy': False, 'transmission': False, 'layers': False}
        self.least_roughness = 1.0
        # Whether the weight of the closure at hand may be another at each place or side.
        self.weight_varies = False
        self.warnings = []
        self.depends_on_objects = False
        self._texture_slots = {}
        self._memo = {}
        self._shared = {}
        self._warned = set()
        self._count = 0

    # Writing code

    def take_number(self):
        """Return a number that no variable has yet."""
        self._count += 1
        return self._count - 1

    def declare(self, kind, expression):
        """Write `expression` to a new variable; return it as a `Value` of `kind`."""
        name = f'v{self.take_number()}'
        self.lines.append(f'{"float" if kind == "float" else "vec3"} {name} = {expression};')
        return Value(kind, name)

    def declare_vec4(self, expression):
        """Write a vec4 expression to a new variable; return the variable's name."""
        name = f'v{self.take_number()}'
        self.lines.append(f'vec4 {name} = {expression};')
        return name

    def shared(self, key, create):
        """Return what `create()` returned when it was first called for `key`."""
        if key not in self._shared:
            self._shared[key] = create()
        return self._shared[key]

    def statement(self, line):
        """Write one statement."""
        self.lines.append(line)

    def function(self, prefix, create, kind='float'):
        """Write a function of a hit whose value `create()` returns; return its name.

        What `create` asks for is written inside it, even if it is written outside as well.
        """
        name = f'{prefix}{self.take_number()}'
        outside = self.lines, self._memo, self._shared, self.normal
        # Outputs that are being computed stay known, or a loop of links would never end.
        unfinished = {key: None for key, value in self._memo.items() if value is None}
        self.lines, self._memo, self._shared, self.normal = [], unfinished, {}, 'hit.normal'
        result = create()
        body = ''.join(f'    {line}\n' for line in self.lines)
        self.lines, self._memo, self._shared, self.normal = outside
        self.functions.append(
            f'{"float" if kind == "float" else "vec3"} {name}(const Hit hit)\n{{\n{body}    return {result};\n}}\n')
        return name

    def note_glossy(self, roughness):
        """Note that the closure at hand reflects, with this roughness (None: any)."""
        self.facts['glossy'] = True
        self.least_roughness = min(self.least_roughness, 0.0 if roughness is None else roughness)

    def note_emission(self, *values):
        """Note that the closure at hand emits by these values (`Value`) and its weight."""
        self.facts['emission'] = True
        if self.weight_varies or any(value.constant is None for value in values):
            self.facts['emission_varies'] = True

    def helper(self, name):
        """Make a helper function (and those it calls) available; return its name."""
        helpers.require(self.helpers, name)
        return name

    def parameter(self, kind, number):
        """Store a constant in the block; return it as a `Value`."""
        if kind == 'float':
            return Value(kind, self.parameters.scalar(number), number)
        return Value(kind, self.parameters.vector(number), tuple(number))

    # Reading the surface or the world direction

    def shading_normal(self):
        """The normal that a node sees when none is linked, world axes."""
        return self.normal if self.domain == 'material' else '(-direction)'

    def view_vector(self):
        """Unit vector towards the viewer, world axes."""
        return 'hit.view' if self.domain == 'material' else '(-direction)'

    def world_position(self):
        """Position in world space; in the world's own shader, the direction."""
        return 'hit_world_position(hit)' if self.domain == 'material' else 'direction'

    def generated(self):
        """Coordinates that an unlinked procedural texture uses."""
        if self.domain != 'material':
            return 'direction'
        return f'hit_generated(hit, {self.attribute(UNDEFORMED)})'

    def attribute(self, name):
        """Return the GLSL argument for a named attribute of the mesh."""
        if name not in self.attributes:
            self.attributes.append(name)
        return f'ATTRIBUTE({self.attributes.index(name)})'

    def uv(self, name):
        """Return a vec2 expression: the UV map of this name, or the default one for ''."""
        if self.domain != 'material':
            return 'vec2(0.0)'
        return f'hit_uv(hit, {self.attribute(name) if name else "UV_DEFAULT"})'

    def texture(self, image, interpolation, extension, user):
        """Return the index of a texture in the shader's list, shared where all three agree."""
        key = (image.as_pointer(), interpolation, extension)
        if key not in self._texture_slots:
            self._texture_slots[key] = len(self.textures)
            self.textures.append((image, interpolation, extension, user))
        return self._texture_slots[key]

    # Following links

    def source_number(self, source):
        """Return the constant of a source that is no node output."""
        kinds = list(source.kinds)
        if source.socket is None:
            number = 0.0 if kinds[-1] in ('float', 'shader') else (0.0, 0.0, 0.0)
        else:
            number = socket_number(source.socket)
            kinds[-1] = socket_kind(source.socket)
        for current, following in zip(reversed(kinds), list(reversed(kinds))[1:]):
            if 'shader' not in (current, following):
                number = convert_number(number, current, following)
        return number

    def source_value(self, source):
        """Return the `Value` of a source, converted along the sockets that were passed."""
        if source.node is None:
            kind = source.kinds[0]
            return self.parameter('float' if kind == 'shader' else kind, self.source_number(source))
        value = self.output_value(NodeUse(self, source.node, source.scope), source.socket)
        for kind in reversed(source.kinds):
            if kind != 'shader':
                value = convert(value, kind)
        return value

    def output_value(self, use, socket):
        """Return the `Value` of a node's output, computed once however often it is read."""
        key = (use.scope.path, use.node.as_pointer(), socket.identifier)
        if key in self._memo:
            value = self._memo[key]
            # A loop of links reaches an output that is still being computed.
            return self._zero(socket) if value is None else value
        self._memo[key] = None
        handler = VALUE_NODES.get(use.node.type)
        value = handler(use, socket.identifier) if handler else self._unsupported(use, socket)
        self._memo[key] = value
        return value

    @staticmethod
    def _zero(socket):
        kind = socket_kind(socket)
        if kind in ('float', 'shader'):
            return Value('float', '0.0', 0.0)
        return Value(kind, 'vec3(0.0)', (0.0, 0.0, 0.0))

    def _unsupported(self, use, socket):
        """Stand-in for an output of an unknown node: its first linked input, else a medium value."""
        kind = socket_kind(socket)
        if kind == 'shader':
            kind = 'color'
        if kind == 'vector' and 'Normal' in socket.name:
            self.warn(use.node, 'the surface normal')
            return Value(kind, self.shading_normal())
        for candidate in use.node.inputs:
            source = resolve(use.scope, candidate)
            if source.node is not None and source.kinds[0] == kind:
                self.warn(use.node, f'its input {candidate.name}')
                return convert(self.source_value(source), kind)
        self.warn(use.node, 'a medium grey' if kind == 'color' else 'a constant')
        return self.parameter(kind, 0.5 if kind == 'float' else (0.5, 0.5, 0.5))

    # Telling the artist

    def warn(self, node, instead, what='is not supported yet'):
        """Add one sentence about a node; each kind of node is named once per data-block."""
        label = node.bl_label or node.name
        self.warn_once((node.type, what, instead),
                       f'{self.owner}: node {label} {what}; {instead} is used instead.')

    def warn_once(self, key, sentence):
        """Add a sentence unless one was added for `key` before."""
        if key not in self._warned:
            self._warned.add(key)
            self.warnings.append(sentence)
