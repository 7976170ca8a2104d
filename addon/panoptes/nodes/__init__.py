# SPDX-License-Identifier: GPL-3.0-or-later
"""Node trees of materials and worlds, compiled to GLSL functions and blocks of values.

`compile_material` and `compile_world` are the whole interface. They read Blender's data and call
nothing native, so that they can be tested alone.
"""

from typing import NamedTuple, Optional

import numpy as np

from .. import compat
from . import helpers
from .compiler import UNDEFORMED, Compiler, deep_recursion  # noqa: F401
from . import (bump, closures, colors, converters, images,  # noqa: F401 (register their nodes)
               inputs, noise, principled, spaces, spectra, textures)
from .scope import Scope, resolve
from .world import write_world


class CompiledShader(NamedTuple):
    """A material or world ready for the native side.

    `code` is GLSL, identical for trees of the same structure. `params` is float32[P, 4], at least
    one row. `textures` lists (Image, 'LINEAR' or 'CLOSEST', 'REPEAT', 'EXTEND' or 'CLIP',
    ImageUser). `facts` are the booleans alpha, emission, emission_varies (over the surface or by
    its side), normal_map, glossy, transmission and layers (a coat or a sheen), and 'attributes',
    the names behind ATTRIBUTE(n). `constant` is a world's radiance (r, g, b) where it is the same in
    every direction, else None. `warnings` are sentences for the artist. `least_roughness`
    is that of all that reflects, 0 where it is not known: a value, of which `code` knows nothing.
    """

    code: str
    params: np.ndarray
    textures: list
    facts: dict
    warnings: list
    constant: Optional[tuple] = None
    depends_on_objects: bool = False
    least_roughness: float = 0.0


def _finish(compiler, signature, result_lines, constant=None):
    body = ''.join(f'    {line}\n' for line in compiler.lines + result_lines)
    before = helpers.source(compiler.helpers) + ''.join(compiler.functions)
    code = f'{before}{signature}\n{{\n{body}}}\n'
    rows = compiler.parameters.rows or [[0.0, 0.0, 0.0, 0.0]]
    params = np.nan_to_num(np.array(rows, np.float32), posinf=3e38, neginf=-3e38)
    facts = dict(compiler.facts, attributes=list(compiler.attributes))
    return CompiledShader(code, params, compiler.textures, facts, compiler.warnings, constant,
                          compiler.depends_on_objects, compiler.least_roughness)


def _quoted(kind, name):
    return f"{kind} '{name}'"


def _output_node(tree, kind):
    """Return the active output node of a shader tree, or None."""
    found = tree.get_output_node('CYCLES')
    if found is not None and found.type == kind:
        return found
    outputs = [node for node in tree.nodes if node.type == kind]
    return next((node for node in outputs if node.is_active_output), outputs[0] if outputs else None)


def compile_material(material):
    """Compile a (preferably evaluated) Material; never fails on account of its nodes."""
    compiler = Compiler('material', _quoted('Material', material.name), material.pass_index)
    if not compat.uses_nodes(material):
        color = compiler.parameter('color', tuple(material.diffuse_color)[:3]).code
        compiler.statement(
            f'closure_diffuse(surface, vec3(1.0), {color}, 0.0, {compiler.shading_normal()});')
    else:
        output = _output_node(material.node_tree, 'OUTPUT_MATERIAL')
        if output is not None:
            with deep_recursion():
                scope = Scope(material.node_tree)
                bump.write_displacement(compiler, material,
                                        resolve(scope, output.inputs['Displacement']))
                closures.write_surface(compiler, resolve(scope, output.inputs['Surface']))
            if resolve(scope, output.inputs['Volume']).node is not None:
                compiler.warn_once('Volume', f'{compiler.owner}: volume is not supported yet; '
                                             'the inside is empty.')
    return _finish(compiler, 'void evaluate_material(const Hit hit, inout Surface surface)', [])


def compile_world(world):
    """Compile a World, or None for a scene without one (black)."""
    compiler = Compiler('world', _quoted('World', world.name if world else ''))
    if world is None:
        radiance, constant = 'vec3(0.0)', (0.0, 0.0, 0.0)
    elif not compat.uses_nodes(world):
        value = compiler.parameter('color', tuple(world.color)[:3])
        radiance, constant = value.code, value.constant
    else:
        radiance, constant = 'vec3(0.0)', (0.0, 0.0, 0.0)
        output = _output_node(world.node_tree, 'OUTPUT_WORLD')
        if output is not None:
            with deep_recursion():
                scope = Scope(world.node_tree)
                radiance, constant = write_world(compiler, resolve(scope, output.inputs['Surface']))
                if resolve(scope, output.inputs['Volume']).node is not None:
                    compiler.warn_once('Volume', f'{compiler.owner}: volume is not supported yet; '
                                                 'the air is clear.')
    return _finish(compiler, 'vec3 evaluate_world(vec3 direction)', [f'return {radiance};'],
                   constant)
