# SPDX-License-Identifier: GPL-3.0-or-later
"""Normals from heights: the Bump node, and a material's Displacement where it is drawn as bumps.

A height may be any tree, so it becomes a GLSL function of the hit, which is called at the hit and at
two places one pixel beside it. A tree without bumps has no such function.
"""

from .. import compat
from .compiler import NodeUse, value_node
from .values import Value


def _height(compiler, create):
    """Write the function of a height; return expressions of it here, along dx and along dy.

    `create()` returns the height as an expression, writing to the function's own lines. Returns
    (offset along dx, offset along dy, vec3 of the three heights).
    """
    name = compiler.function('height', create)
    x = compiler.declare('vector', 'bump_offset_x(hit)').code
    y = compiler.declare('vector', f'bump_offset_y(hit, {x})').code
    return x, y, (f'vec3({name}(hit), {name}(shifted_hit(hit, {x})), '
                  f'{name}(shifted_hit(hit, {y})))')


@value_node('BUMP')
def bump(use, output):
    """Bump node."""
    compiler = use.compiler
    if compiler.domain != 'material' or not use.is_linked('Height'):
        return Value('vector', use.normal())
    compiler.facts['normal_map'] = True
    normal = use.normal()
    x, y, heights = _height(compiler, lambda: use.get('Height', 'float'))
    distance = use.get('Distance', 'float')
    if use.node.invert:
        distance = f'-({distance})'
    strength = use.get('Strength', 'float')
    return use.declare('vector', f'bump_normal(hit, {normal}, {x}, {y}, {heights}, {distance}, '
                                 f'{strength})')


def write_displacement(compiler, material, source):
    """Let the surface's normal be that of its displacement, whose `Source` is `source`."""
    if source.node is None:
        return
    if source.node.type != 'DISPLACEMENT':
        compiler.warn(source.node, 'the smooth surface', 'does not displace yet')
        return
    if compat.displacement_method(material) != 'BUMP':
        compiler.warn_once('Displacement', f'{compiler.owner}: displacement does not move the '
                                           'surface yet; it is drawn as bumps.')
    use = NodeUse(compiler, source.node, source.scope)
    compiler.facts['normal_map'] = True

    def height():
        parts = [use.get(name, 'float') for name in ('Height', 'Midlevel', 'Scale')]
        offset = '({} - {}) * {}'.format(*parts)
        return f'height_in_world(hit, {offset})' if source.node.space == 'OBJECT' else offset

    x, y, heights = _height(compiler, height)
    compiler.normal = compiler.declare(
        'vector', f'bump_normal(hit, hit.normal, {x}, {y}, {heights}, 1.0, 1.0)').code
    compiler.statement(f'surface.smooth_normal = {compiler.normal};')
