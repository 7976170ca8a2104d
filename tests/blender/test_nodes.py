# SPDX-License-Identifier: GPL-3.0-or-later
"""Node trees -> GLSL: every supported node compiles, code holds no values, facts are right."""

import bpy
import numpy as np
import pytest

from panoptes import compat, nodes
from trees import Tree, check


def choices(node, name):
    return [item.identifier for item in node.bl_rna.properties[name].enum_items]


def compiled_with(kind, **settings):
    """Compile a material for each output of a node of this kind; all inputs keep their values."""
    found = []
    for index in range(len(_node_outputs(kind))):
        tree = Tree()
        node = tree.add(kind, **settings)
        if not node.outputs[index].enabled:
            continue
        tree.link(node, index, tree.surface, 'Base Color')
        found.append(tree.compile())
    assert found
    return found


def _node_outputs(kind):
    tree = Tree()
    return tree.add(kind).outputs


VALUE_NODES = ['RGB', 'Value', 'UVMap', 'TexCoord', 'NewGeometry', 'Fresnel', 'LayerWeight',
               'VertexColor', 'MixRGB', 'Mix', 'Invert', 'Gamma', 'BrightContrast', 'HueSaturation',
               'RGBToBW', 'Math', 'VectorMath', 'MapRange', 'Clamp', 'ValToRGB', 'RGBCurve',
               'VectorCurve', 'FloatCurve', 'SeparateColor', 'CombineColor', 'SeparateXYZ',
               'CombineXYZ', 'Mapping', 'TexChecker', 'TexGradient', 'NormalMap', 'Bump', 'Attribute',
               'LightPath', 'TexImage', 'TexEnvironment']

OPTIONS = [('Math', 'operation'), ('VectorMath', 'operation'), ('MixRGB', 'blend_type'),
           ('MapRange', 'interpolation_type'), ('Clamp', 'clamp_type'), ('SeparateColor', 'mode'),
           ('CombineColor', 'mode'), ('Mapping', 'vector_type'), ('NormalMap', 'space'),
           ('TexGradient', 'gradient_type')]


@pytest.mark.parametrize('kind', VALUE_NODES)
def test_value_node(scene, tmp_path, kind):
    shaders = compiled_with('ShaderNode' + kind)
    for shader in shaders:
        assert shader.code.count('void evaluate_material(') == 1
        assert shader.params.dtype == np.float32 and shader.params.shape[1] == 4
    check(tmp_path, shaders)


@pytest.mark.parametrize('kind, option', OPTIONS)
def test_every_option(scene, tmp_path, kind, option):
    kind = 'ShaderNode' + kind
    node = Tree().add(kind)
    shaders = []
    for choice in choices(node, option):
        for shader in compiled_with(kind, **{option: choice}):
            assert not [w for w in shader.warnings if 'has no' in w], shader.warnings
            shaders.append(shader)
    check(tmp_path, shaders)


def test_mix_node_in_every_data_type(scene, tmp_path):
    shaders = []
    for data_type in ('FLOAT', 'VECTOR', 'RGBA'):
        shaders += compiled_with('ShaderNodeMix', data_type=data_type, clamp_factor=False)
    shaders += compiled_with('ShaderNodeMix', data_type='VECTOR', factor_mode='NON_UNIFORM')
    for blend in choices(Tree().add('ShaderNodeMix'), 'blend_type'):
        shaders += compiled_with('ShaderNodeMix', data_type='RGBA', blend_type=blend,
                                 clamp_result=True)
    check(tmp_path, shaders)


def test_map_range_of_vectors(scene, tmp_path):
    shaders = []
    for kind in ('LINEAR', 'STEPPED', 'SMOOTHSTEP', 'SMOOTHERSTEP'):
        shaders += compiled_with('ShaderNodeMapRange', data_type='FLOAT_VECTOR',
                                 interpolation_type=kind)
    check(tmp_path, shaders)


@pytest.mark.parametrize('kind', ['BsdfDiffuse', 'BsdfGlossy', 'BsdfGlass', 'BsdfRefraction',
                                  'BsdfTransparent', 'Emission', 'BsdfPrincipled', 'AddShader',
                                  'MixShader', 'Background', 'SubsurfaceScattering',
                                  'BsdfTranslucent', 'Holdout'])
def test_closure(scene, tmp_path, kind):
    check(tmp_path, [Tree('ShaderNode' + kind).compile()])


@pytest.mark.parametrize('kind, words', [
    ('Glossy', 'closure_glossy_multiscatter(hit, surface, '),
    ('Glass', 'closure_glass_multiscatter(hit, surface, '),
    ('Principled', '.multiscatter = true;')])
def test_several_bounces_where_the_distribution_asks_for_them(scene, tmp_path, kind, words):
    for distribution in ('GGX', 'MULTI_GGX'):
        tree = Tree('ShaderNodeBsdf' + kind)
        tree.surface.distribution = distribution
        shader = tree.compile()
        assert (words in shader.code) == (distribution == 'MULTI_GGX')
        check(tmp_path, [shader])


def test_material_without_nodes(scene, tmp_path):
    material = bpy.data.materials.new('Plain')
    if compat.VERSION >= (5, 0, 0):
        material.node_tree.nodes.clear()
    else:
        material.use_nodes = False
    material.diffuse_color = (0.1, 0.2, 0.3, 1.0)
    shader = nodes.compile_material(material)
    assert 'closure_diffuse' in shader.code
    assert np.allclose(shader.params[0, :3], (0.1, 0.2, 0.3))
    check(tmp_path, [shader])


def test_values_change_parameters_only(scene):
    tree = Tree()
    first = tree.compile()
    tree.surface.inputs['Roughness'].default_value = 0.123
    tree.surface.inputs['Base Color'].default_value = (0.9, 0.1, 0.1, 1.0)
    second = tree.compile()
    assert first.code == second.code and first.facts == second.facts
    assert not np.array_equal(first.params, second.params)


def test_same_structure_gives_the_same_code(scene):
    def build(value):
        tree = Tree()
        for _ in range(2):
            node = tree.add('ShaderNodeMath', operation='MULTIPLY')
            node.inputs[1].default_value = value
        tree.link(node, 0, tree.surface, 'Roughness')
        return tree.compile()

    assert build(0.3).code == build(0.7).code


def test_ramp_stops_are_parameters(scene):
    tree = Tree()
    ramp = tree.add('ShaderNodeValToRGB')
    tree.link(ramp, 0, tree.surface, 'Base Color')
    first = tree.compile()
    ramp.color_ramp.elements[0].color = (1.0, 0.0, 0.0, 1.0)
    ramp.color_ramp.elements.new(0.3)
    second = tree.compile()
    assert first.code == second.code
    assert len(first.params) >= 256


class TestFacts:
    """Facts are conservative, and a term that is off is not in the code."""

    def test_plain(self, scene):
        facts = Tree().compile().facts
        assert facts == {'alpha': False, 'emission': False, 'emission_varies': False,
                         'normal_map': False, 'glossy': True, 'transmission': False,
                         'layers': False, 'attributes': []}

    def test_alpha(self, scene):
        tree = Tree()
        tree.surface.inputs['Alpha'].default_value = 0.5
        assert tree.compile().facts['alpha']

    def test_emission_strength_zero_is_left_out(self, scene):
        tree = Tree()
        name = compat.PRINCIPLED_SOCKETS['emission']
        tree.surface.inputs[name].default_value = (1.0, 1.0, 1.0, 1.0)
        tree.surface.inputs['Emission Strength'].default_value = 0.0
        shader = tree.compile()
        assert not shader.facts['emission'] and '.emission' not in shader.code
        tree.surface.inputs['Emission Strength'].default_value = 1.0
        shader = tree.compile()
        assert shader.facts['emission'] and '.emission' in shader.code

    def test_emission_node_of_strength_zero(self, scene):
        tree = Tree('ShaderNodeEmission')
        tree.surface.inputs['Strength'].default_value = 0.0
        shader = tree.compile()
        assert not shader.facts['emission'] and 'closure' not in shader.code

    @pytest.mark.parametrize('kind', ['ShaderNodeEmission', 'ShaderNodeBsdfPrincipled'])
    def test_emission_varies_where_a_node_decides(self, scene, kind):
        color = 'Color' if kind == 'ShaderNodeEmission' else compat.PRINCIPLED_SOCKETS['emission']
        sockets = ['Alpha'] if kind == 'ShaderNodeBsdfPrincipled' else []
        strength = 'Strength' if kind == 'ShaderNodeEmission' else 'Emission Strength'
        for socket in [None, color, strength, *sockets]:
            tree = Tree(kind)
            tree.surface.inputs[color].default_value = (1.0, 0.5, 0.2, 1.0)
            tree.surface.inputs[strength].default_value = 2.0
            if sockets:
                tree.surface.inputs['Alpha'].default_value = 0.5
            facts = tree.compile().facts
            assert facts['emission'] and not facts['emission_varies']
            if socket:
                tree.link(tree.add('ShaderNodeTexNoise'), 'Fac', tree.surface, socket)
                facts = tree.compile().facts
                assert facts['emission'] and facts['emission_varies'], socket

    def test_emission_does_not_vary_by_values_of_nodes(self, scene):
        tree = Tree('ShaderNodeEmission')
        tree.link(tree.add('ShaderNodeValue'), 0, tree.surface, 'Strength')
        assert not tree.compile().facts['emission_varies']

    def test_emission_varies_with_the_weight_of_its_closure(self, scene):
        for factor in (None, 'ShaderNodeNewGeometry', 'ShaderNodeLayerWeight'):
            tree = Tree('ShaderNodeMixShader')
            inner = tree.add('ShaderNodeAddShader')
            tree.link(tree.add('ShaderNodeEmission'), 0, inner, 0)
            tree.link(tree.add('ShaderNodeBsdfDiffuse'), 0, inner, 1)
            tree.link(inner, 0, tree.surface, 2)
            if factor:
                output = 'Backfacing' if factor == 'ShaderNodeNewGeometry' else 'Facing'
                tree.link(tree.add(factor), output, tree.surface, 0)
            facts = tree.compile().facts
            assert facts['emission'] and facts['emission_varies'] == (factor is not None)

    def test_transmission(self, scene):
        tree = Tree()
        tree.surface.inputs[compat.PRINCIPLED_SOCKETS['transmission']].default_value = 1.0
        assert tree.compile().facts['transmission']
        assert Tree('ShaderNodeBsdfGlass').compile().facts['transmission']

    def test_not_glossy(self, scene):
        tree = Tree()
        tree.surface.inputs[compat.PRINCIPLED_SOCKETS['specular']].default_value = 0.0
        assert not tree.compile().facts['glossy']
        assert not Tree('ShaderNodeBsdfDiffuse').compile().facts['glossy']

    def test_least_roughness(self, scene):
        coat = compat.PRINCIPLED_SOCKETS['coat']
        tree = Tree()
        tree.surface.inputs['Roughness'].default_value = 0.75
        rough = tree.compile()
        assert rough.least_roughness == 0.75
        tree.surface.inputs['Roughness'].default_value = 0.25
        smooth = tree.compile()
        assert smooth.least_roughness == 0.25
        assert (smooth.code, smooth.facts) == (rough.code, rough.facts), 'a value asks for a new program'
        tree.surface.inputs[coat].default_value = 1.0
        assert tree.compile().least_roughness == pytest.approx(0.03)
        tree.surface.inputs[coat].default_value = 0.0
        tree.link(tree.add('ShaderNodeTexNoise'), 'Fac', tree.surface, 'Roughness')
        assert tree.compile().least_roughness == 0
        assert Tree('ShaderNodeBsdfDiffuse').compile().least_roughness == 1

    def test_normal_map_and_attributes(self, scene):
        tree = Tree()
        node = tree.add('ShaderNodeNormalMap', uv_map='Other')
        tree.link(node, 0, tree.surface, 'Normal')
        facts = tree.compile().facts
        assert facts['normal_map'] and facts['attributes'] == ['Other']


class TestShaders:
    """Mix and Add Shader."""

    def mixed(self, factor):
        tree = Tree('ShaderNodeMixShader')
        red, glass = tree.add('ShaderNodeBsdfDiffuse'), tree.add('ShaderNodeBsdfGlass')
        tree.link(red, 0, tree.surface, 'Shader')
        tree.link(glass, 0, tree.surface, 'Shader_001')
        tree.surface.inputs[0].default_value = factor
        return tree

    def test_both_sides(self, scene, tmp_path):
        shader = self.mixed(0.5).compile()
        assert 'closure_diffuse' in shader.code and 'closure_glass' in shader.code
        check(tmp_path, [shader])

    def test_a_side_that_is_off_costs_nothing(self, scene):
        shader = self.mixed(0.0).compile()
        assert 'closure_diffuse' in shader.code and 'closure_glass' not in shader.code
        assert not shader.facts['transmission']
        assert 'closure_diffuse' not in self.mixed(1.0).compile().code

    def test_closure_that_is_reached_twice_is_written_once(self, scene, tmp_path):
        tree = Tree('ShaderNodeAddShader')
        diffuse = tree.add('ShaderNodeBsdfDiffuse')
        tree.link(diffuse, 0, tree.surface, 'Shader')
        tree.link(diffuse, 0, tree.surface, 'Shader_001')
        shader = tree.compile()
        assert shader.code.count('closure_diffuse') == 1
        assert 'vec3(1.0) + vec3(1.0)' in shader.code
        check(tmp_path, [shader])

    def test_many_nested_mixes_stay_small(self, scene):
        tree = Tree('ShaderNodeAddShader')
        node = tree.add('ShaderNodeBsdfDiffuse')
        for _ in range(40):
            following = tree.add('ShaderNodeAddShader')
            tree.link(node, 0, following, 'Shader')
            tree.link(node, 0, following, 'Shader_001')
            node = following
        tree.link(node, 0, tree.output, 'Surface')
        assert len(tree.compile().code) < 10000

    def test_color_linked_to_the_surface_shines(self, scene, tmp_path):
        tree = Tree()
        rgb = tree.add('ShaderNodeRGB')
        tree.link(rgb, 0, tree.output, 'Surface')
        shader = tree.compile()
        assert shader.facts['emission']
        check(tmp_path, [shader])


class TestStructure:
    """Groups, reroutes, muted nodes, loops, deep trees."""

    def grouped(self, tree, value):
        group = bpy.data.node_groups.new('Group', 'ShaderNodeTree')
        if hasattr(group, 'interface'):
            group.interface.new_socket('In', in_out='INPUT', socket_type='NodeSocketFloat')
            group.interface.new_socket('Out', in_out='OUTPUT', socket_type='NodeSocketColor')
        else:
            group.inputs.new('NodeSocketFloat', 'In')
            group.outputs.new('NodeSocketColor', 'Out')
        start, end = group.nodes.new('NodeGroupInput'), group.nodes.new('NodeGroupOutput')
        math = group.nodes.new('ShaderNodeMath')
        group.links.new(start.outputs[0], math.inputs[0])
        group.links.new(math.outputs[0], end.inputs[0])
        node = tree.add('ShaderNodeGroup', node_tree=group)
        node.inputs[0].default_value = value
        return node

    def test_group(self, scene, tmp_path):
        tree = Tree()
        tree.link(self.grouped(tree, 0.25), 0, tree.surface, 'Base Color')
        shader = tree.compile()
        assert 0.25 in shader.params
        check(tmp_path, [shader])

    def test_one_group_used_twice(self, scene, tmp_path):
        tree = Tree()
        first = self.grouped(tree, 0.25)
        second = tree.add('ShaderNodeGroup', node_tree=first.node_tree)
        second.inputs[0].default_value = 0.75
        tree.link(first, 0, tree.surface, 'Base Color')
        tree.link(second, 0, tree.surface, 'Roughness')
        shader = tree.compile()
        assert 0.25 in shader.params and 0.75 in shader.params
        check(tmp_path, [shader])

    def test_group_without_tree(self, scene, tmp_path):
        tree = Tree()
        group = self.grouped(tree, 0.5)
        tree.link(group, 0, tree.surface, 'Base Color')
        bpy.data.node_groups.remove(group.node_tree)
        check(tmp_path, [tree.compile()])

    def test_reroute(self, scene):
        tree = Tree()
        rgb, reroute = tree.add('ShaderNodeRGB'), tree.add('NodeReroute')
        rgb.outputs[0].default_value = (0.125, 0.0, 0.0, 1.0)
        tree.link(rgb, 0, reroute, 0)
        tree.link(reroute, 0, tree.surface, 'Base Color')
        assert 0.125 in tree.compile().params

    def test_muted_node_passes_its_input_on(self, scene):
        tree = Tree()
        rgb, invert = tree.add('ShaderNodeRGB'), tree.add('ShaderNodeInvert')
        tree.link(rgb, 0, invert, 'Color')
        tree.link(invert, 0, tree.surface, 'Base Color')
        plain = len(tree.compile().code)
        invert.mute = True
        assert len(tree.compile().code) < plain

    def test_muted_link(self, scene):
        tree = Tree()
        rgb = tree.add('ShaderNodeRGB')
        rgb.outputs[0].default_value = (0.125, 0.0, 0.0, 1.0)
        tree.link(rgb, 0, tree.surface, 'Base Color')
        tree.material.node_tree.links[-1].is_muted = True
        assert 0.125 not in tree.compile().params

    def test_loop_ends(self, scene, tmp_path):
        tree = Tree()
        first, second = (tree.add('ShaderNodeMath') for _ in range(2))
        tree.link(first, 0, second, 0)
        tree.link(second, 0, first, 0)
        tree.link(second, 0, tree.surface, 'Roughness')
        mix, other = tree.add('ShaderNodeMixShader'), tree.add('ShaderNodeMixShader')
        tree.link(mix, 0, other, 1)
        tree.link(other, 0, mix, 1)
        tree.link(mix, 0, tree.output, 'Surface')
        tree.link(tree.surface, 0, mix, 2)
        check(tmp_path, [tree.compile()])

    def test_reroute_loop_ends(self, scene):
        tree = Tree()
        first, second = (tree.add('NodeReroute') for _ in range(2))
        tree.link(first, 0, second, 0)
        tree.link(second, 0, first, 0)
        tree.link(second, 0, tree.surface, 'Roughness')
        tree.compile()

    def test_chain_of_a_thousand_nodes(self, scene):
        tree = Tree()
        node = tree.add('ShaderNodeValue')
        for _ in range(1000):
            following = tree.add('ShaderNodeMath')
            tree.link(node, 0, following, 0)
            node = following
        tree.link(node, 0, tree.surface, 'Roughness')
        assert tree.compile().code.count('float v') >= 1000


class TestUnsupported:
    """Unknown nodes are named once and replaced."""

    def test_named_once(self, scene, tmp_path):
        tree = Tree()
        for name in ('Base Color', 'Roughness'):
            tree.link(tree.add('ShaderNodeTexSky'), 'Color', tree.surface, name)
        shader = tree.compile()
        assert len(shader.warnings) == 1
        assert shader.warnings[0] == ("Material 'Test': node Sky Texture is not supported yet; a "
                                      'medium grey is used instead.')
        check(tmp_path, [shader])

    def test_first_linked_input_is_passed_on(self, scene):
        tree = Tree()
        rgb, unknown = tree.add('ShaderNodeRGB'), tree.add('ShaderNodeAmbientOcclusion')
        rgb.outputs[0].default_value = (0.125, 0.0, 0.0, 1.0)
        tree.link(rgb, 0, unknown, 'Color')
        tree.link(unknown, 'Color', tree.surface, 'Base Color')
        shader = tree.compile()
        assert 0.125 in shader.params and len(shader.warnings) == 1
