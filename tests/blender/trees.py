# SPDX-License-Identifier: GPL-3.0-or-later
"""Building node trees in tests, and checking the GLSL that comes out of them."""

import bpy

import glsl
from panoptes import compat, nodes


class Tree:
    """A material whose node tree is built in a few words."""

    def __init__(self, surface='ShaderNodeBsdfPrincipled'):
        self.material = bpy.data.materials.new('Test')
        self.material.use_nodes = True
        self.nodes = self.material.node_tree.nodes
        self.nodes.clear()
        self.output = self.add('ShaderNodeOutputMaterial')
        self.surface = self.add(surface)
        self.link(self.surface, 0, self.output, 'Surface')

    def add(self, kind, **settings):
        node = self.nodes.new(kind)
        for name, value in settings.items():
            setattr(node, name, value)
        return node

    def link(self, node, output, target, socket):
        if isinstance(socket, str):
            socket = compat.find_socket(target.inputs, socket)
        else:
            socket = target.inputs[socket]
        if isinstance(output, str):
            output = compat.find_socket(node.outputs, output)
        else:
            output = node.outputs[output]
        self.material.node_tree.links.new(output, socket)

    def compile(self):
        return nodes.compile_material(self.material)


def check(tmp_path, shaders, domain='material'):
    if glsl.available():
        report = glsl.validate(tmp_path, shaders, domain)
        assert not report, report
