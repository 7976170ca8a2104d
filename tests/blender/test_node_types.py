# SPDX-License-Identifier: GPL-3.0-or-later
"""Every node type that this Blender offers: each ends in GLSL that compiles, and says what it leaves out."""

import bpy
import pytest

from panoptes import nodes
from trees import Tree, check

# Nodes that only a group or an output makes sense of; their own tests are in test_nodes.py.
_STRUCTURE = ('GROUP', 'GROUP_INPUT', 'GROUP_OUTPUT', 'FRAME', 'REROUTE', 'CUSTOM')


def node_types(tree):
    """The names of all nodes that the shader editor can add."""
    found = []
    for name in dir(bpy.types):
        kind = getattr(bpy.types, name)
        if not (isinstance(kind, type) and issubclass(kind, bpy.types.Node)):
            continue
        try:
            node = tree.nodes.new(name)
        except RuntimeError:
            continue  # a base class, or a node of another editor
        if node.type not in _STRUCTURE and not node.type.startswith('OUTPUT'):
            found.append(name)
        tree.nodes.remove(node)
    return found


def every_use(kind, domain):
    """Compile the node with each of its outputs as a surface's colour or as the surface itself."""
    shaders = []
    for index, _ in enumerate(Tree().add(kind).outputs):
        if domain == 'material':
            tree = Tree()
            node = tree.add(kind)
            target = tree.output.inputs['Surface'] if node.outputs[index].type == 'SHADER' else \
                tree.surface.inputs['Base Color']
            tree.material.node_tree.links.new(node.outputs[index], target)
            shaders.append(tree.compile())
        else:
            world = bpy.data.worlds.new('World')
            world.use_nodes = True
            node = world.node_tree.nodes.new(kind)
            output = next(n for n in world.node_tree.nodes if n.type == 'OUTPUT_WORLD')
            world.node_tree.links.new(node.outputs[index], output.inputs['Surface'])
            shaders.append(nodes.compile_world(world))
    return shaders


@pytest.mark.parametrize('domain', ['material', 'world'])
def test_every_node_compiles(scene, tmp_path, domain):
    shaders, silent = [], []
    kinds = node_types(Tree())
    assert len(kinds) > 80
    for kind in kinds:
        found = every_use(kind, domain)
        shaders += found
        for shader in found:
            assert len(shader.warnings) == len(set(shader.warnings)), (kind, shader.warnings)
            assert all(s.endswith('.') and 'Test' in s or 'World' in s for s in shader.warnings)
        if found and not any(shader.warnings for shader in found):
            silent.append(kind)
    check(tmp_path, shaders, domain)
    # What is not supported must not pass in silence.
    for kind in ('ShaderNodeScript', 'ShaderNodeTexPointDensity', 'ShaderNodeAmbientOcclusion'):
        assert kind not in silent


def test_inputs_that_are_linked_to_everything(scene, tmp_path):
    """Each input of each node, fed by a colour, a number and a vector: conversions meet everywhere."""
    shaders = []
    for kind in node_types(Tree()):
        tree = Tree()
        node = tree.add(kind)
        sources = [tree.add(name) for name in ('ShaderNodeRGB', 'ShaderNodeValue', 'ShaderNodeNewGeometry')]
        for index, socket in enumerate(node.inputs):
            if socket.type not in ('SHADER',) and socket.enabled:
                tree.material.node_tree.links.new(sources[index % 3].outputs[0], socket)
        for output in node.outputs:
            if output.enabled:
                target = tree.output.inputs['Surface'] if output.type == 'SHADER' else \
                    tree.surface.inputs['Base Color']
                tree.material.node_tree.links.new(output, target)
                break
        shaders.append(tree.compile())
    check(tmp_path, shaders)
