# SPDX-License-Identifier: GPL-3.0-or-later
"""Image textures in materials, and worlds."""

import bpy
import pytest

from panoptes import nodes
from trees import Tree, check


class TestTextures:
    """Image textures."""

    def textured(self, alpha, **settings):
        tree = Tree()
        image = bpy.data.images.new('Pixels', 4, 4)
        for name, value in settings.items():
            setattr(image, name, value)
        node = tree.add('ShaderNodeTexImage', image=image)
        tree.link(node, 'Color', tree.surface, 'Base Color')
        if alpha:
            tree.link(node, 'Alpha', tree.surface, 'Alpha')
        return tree

    def test_color_is_divided_where_alpha_is_used(self, scene, tmp_path):
        alone, both = self.textured(False).compile(), self.textured(True).compile()
        assert 'false)' in alone.code and 'true)' in both.code
        assert len(both.textures) == 1 and both.code.count('sample_image') == 1
        check(tmp_path, [alone, both])

    def test_channel_packed_color_is_not_divided(self, scene):
        assert 'true)' not in self.textured(True, alpha_mode='CHANNEL_PACKED').compile().code

    def test_textures_are_shared_by_settings(self, scene):
        tree = self.textured(False)
        image = bpy.data.images[0]
        for settings in ({}, {'interpolation': 'Closest'}, {'extension': 'CLIP'}):
            node = tree.add('ShaderNodeTexImage', image=image, **settings)
            add = tree.add('ShaderNodeMixRGB')
            tree.link(node, 0, add, 'Color1')
            tree.link(add, 0, tree.surface, {0: 'Roughness', 1: 'Metallic', 2: 'Alpha'}[
                len(tree.nodes) % 3])
        uses = [texture[1:3] for texture in tree.compile().textures]
        assert len(uses) == len(set(uses))

    def test_projections(self, scene, tmp_path):
        shaders = []
        for projection in ('FLAT', 'BOX', 'SPHERE', 'TUBE'):
            tree = self.textured(False)
            tree.nodes[-1].projection = projection
            shaders.append(tree.compile())
        check(tmp_path, shaders)

    def test_missing_image_is_magenta_and_named(self, scene, tmp_path):
        tree = Tree()
        node = tree.add('ShaderNodeTexImage')
        tree.link(node, 0, tree.surface, 'Base Color')
        shader = tree.compile()
        assert len(shader.warnings) == 1 and "Material 'Test'" in shader.warnings[0]
        assert [1.0, 0.0, 1.0] in shader.params[:, :3].tolist()


class TestWorld:
    """Worlds."""

    def world(self):
        world = bpy.data.worlds.new('World')
        world.use_nodes = True
        return world

    def background(self, world):
        return next(n for n in world.node_tree.nodes if n.type == 'BACKGROUND')

    def test_constant(self, scene, tmp_path):
        world = self.world()
        node = self.background(world)
        node.inputs['Color'].default_value = (0.5, 0.25, 1.0, 1.0)
        node.inputs['Strength'].default_value = 2.0
        shader = nodes.compile_world(world)
        assert shader.constant == pytest.approx((1.0, 0.5, 2.0))
        check(tmp_path, [shader], 'world')

    def test_no_world_is_black(self, scene, tmp_path):
        shader = nodes.compile_world(None)
        assert shader.constant == (0.0, 0.0, 0.0)
        check(tmp_path, [shader], 'world')

    def test_gradient_is_not_constant(self, scene, tmp_path):
        world = self.world()
        tree = world.node_tree
        coordinate, split = (tree.nodes.new('ShaderNode' + n) for n in ('TexCoord', 'SeparateXYZ'))
        tree.links.new(coordinate.outputs['Generated'], split.inputs[0])
        tree.links.new(split.outputs['Z'], self.background(world).inputs['Color'])
        shader = nodes.compile_world(world)
        assert shader.constant is None
        check(tmp_path, [shader], 'world')

    def test_environment(self, scene, tmp_path):
        world = self.world()
        tree = world.node_tree
        texture = tree.nodes.new('ShaderNodeTexEnvironment')
        texture.image = bpy.data.images.new('Sky', 8, 4, float_buffer=True)
        mapping, coordinate = (tree.nodes.new('ShaderNode' + n) for n in ('Mapping', 'TexCoord'))
        tree.links.new(coordinate.outputs['Generated'], mapping.inputs['Vector'])
        tree.links.new(mapping.outputs[0], texture.inputs[0])
        tree.links.new(texture.outputs[0], self.background(world).inputs['Color'])
        shader = nodes.compile_world(world)
        assert shader.constant is None and len(shader.textures) == 1
        check(tmp_path, [shader], 'world')

    def test_mixed_backgrounds(self, scene, tmp_path):
        world = self.world()
        tree = world.node_tree
        mix, other = tree.nodes.new('ShaderNodeMixShader'), tree.nodes.new('ShaderNodeBackground')
        other.inputs['Color'].default_value = (1.0, 0.0, 0.0, 1.0)
        self.background(world).inputs['Color'].default_value = (0.0, 0.0, 1.0, 1.0)
        tree.links.new(self.background(world).outputs[0], mix.inputs[1])
        tree.links.new(other.outputs[0], mix.inputs[2])
        output = next(n for n in tree.nodes if n.type == 'OUTPUT_WORLD')
        tree.links.new(mix.outputs[0], output.inputs['Surface'])
        mix.inputs[0].default_value = 0.25
        shader = nodes.compile_world(world)
        assert shader.constant == pytest.approx((0.25, 0.0, 0.75))
        check(tmp_path, [shader], 'world')
