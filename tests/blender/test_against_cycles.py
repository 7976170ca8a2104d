# SPDX-License-Identifier: GPL-3.0-or-later
"""Value nodes by their numbers: the same trees rendered by Cycles and by Panoptes.

Every case is one quad that shines with what a node computes from random constants or from the place
on the quad; one orthographic frame shows them all, three pixels a quad.
"""

import math
import os
import random

import bpy
import numpy as np
import pytest

from panoptes import compat, native
from test_engine import render_combined

PIXELS = 3

pytestmark = pytest.mark.skipif(os.environ.get('PANOPTES_TEST_FAST', '') != '',
                                reason='compiles some hundred materials')


class Case:
    """One material: `build(nodes, links)` returns the output socket that is shown."""

    def __init__(self, name, build):
        self.name = name
        self.build = build


def fill(node, generator, low, high):
    """Give every unlinked input a random value."""
    for socket in node.inputs:
        if socket.is_linked or not socket.enabled or not hasattr(socket, 'default_value'):
            continue
        if socket.type == 'VALUE':
            socket.default_value = generator.uniform(low, high)
        elif socket.type == 'VECTOR':
            socket.default_value = [generator.uniform(low, high) for _ in range(3)]
        elif socket.type == 'RGBA':
            socket.default_value = [generator.uniform(max(low, 0), high) for _ in range(3)] + [1.0]


def node_case(kind, output=0, seed=0, low=-1.0, high=1.0, place=None, **settings):
    """A case that shows one output of one node; `place` names an input fed with the position."""

    def build(nodes, links):
        node = nodes.new('ShaderNode' + kind)
        for name, value in settings.items():
            setattr(node, name, value)
        if place is not None:
            geometry = nodes.new('ShaderNodeNewGeometry')
            links.new(geometry.outputs['Position'], compat.find_socket(node.inputs, place))
        fill(node, random.Random(f'{kind}{settings}{seed}'), low, high)
        outputs = [socket for socket in node.outputs if socket.enabled]
        return outputs[output] if isinstance(output, int) else compat.find_socket(outputs, output)

    words = [kind, str(output), *map(str, settings.values()), str(seed)]
    return Case(' '.join(words), build)


def choices(kind, option):
    material = bpy.data.materials.new('Choices')
    material.use_nodes = True
    node = material.node_tree.nodes.new('ShaderNode' + kind)
    found = [item.identifier for item in node.bl_rna.properties[option].enum_items]
    bpy.data.materials.remove(material)
    return found


def make_cases():
    cases = []
    for operation in choices('Math', 'operation'):
        high = 3.0 if operation != 'EXPONENT' else 2.0
        cases += [node_case('Math', 0, seed, -high, high, operation=operation) for seed in range(3)]
    cases.append(node_case('Math', 0, 1, -2, 2, operation='SUBTRACT', use_clamp=True))
    for operation in choices('VectorMath', 'operation'):
        cases += [node_case('VectorMath', 0, seed, -2, 2, operation=operation) for seed in range(2)]
    for mode in choices('MixRGB', 'blend_type'):
        cases += [node_case('MixRGB', 0, seed, 0, 1, blend_type=mode) for seed in range(2)]
        cases.append(node_case('Mix', 0, 7, -0.5, 1.5, data_type='RGBA', blend_type=mode,
                               clamp_factor=False, clamp_result=mode == 'ADD'))
    for factor in ('UNIFORM', 'NON_UNIFORM'):
        cases.append(node_case('Mix', 0, 0, -1, 2, data_type='VECTOR', factor_mode=factor))
    cases.append(node_case('Mix', 0, 0, -1, 2, data_type='FLOAT'))
    for kind in choices('MapRange', 'interpolation_type'):
        for clamp in (True, False):
            cases.append(node_case('MapRange', 0, 1, 0.1, 4, interpolation_type=kind, clamp=clamp))
            cases.append(node_case('MapRange', 0, 2, 0.1, 4, interpolation_type=kind, clamp=clamp,
                                   data_type='FLOAT_VECTOR'))
    for kind in choices('Clamp', 'clamp_type'):
        cases += [node_case('Clamp', 0, seed, clamp_type=kind) for seed in range(3)]
    for mode in ('RGB', 'HSV', 'HSL'):
        cases += [node_case('SeparateColor', output, 0, 0, 1, mode=mode) for output in range(3)]
        cases += [node_case('CombineColor', 0, seed, 0, 1, mode=mode) for seed in range(2)]
    for kind in choices('Mapping', 'vector_type'):
        cases.append(node_case('Mapping', 0, 0, 0.2, 1.5, vector_type=kind))
        cases.append(node_case('Mapping', 0, 0, 0.2, 1.5, place='Vector', vector_type=kind))
        cases.append(node_case('Mapping', 0, 0, 0.2, 1.5, place='Rotation', vector_type=kind))
    for kind in ('Invert', 'Gamma', 'BrightContrast', 'HueSaturation', 'RGBToBW', 'SeparateXYZ',
                 'CombineXYZ'):
        cases += [node_case(kind, 0, seed, 0, 1) for seed in range(2)]
    for output in ('Position', 'Normal', 'True Normal', 'Incoming', 'Backfacing'):
        cases.append(node_case('NewGeometry', output))
    for output in ('Generated', 'Normal', 'UV', 'Object', 'Reflection'):
        cases.append(node_case('TexCoord', output))
    cases += [node_case('Fresnel', 0, seed, 1.1, 2.0) for seed in range(2)]
    cases += [node_case('LayerWeight', output, seed, 0.1, 0.9) for output in (0, 1)
              for seed in range(2)]
    cases += [node_case('TexChecker', output, 0, 2, 5, place='Vector') for output in (0, 1)]
    for kind in choices('TexGradient', 'gradient_type'):
        cases.append(node_case('TexGradient', 0, 0, place='Vector', gradient_type=kind))
    cases += [ramp_case(kind) for kind in ('LINEAR', 'CONSTANT', 'EASE', 'B_SPLINE')]
    cases += [curve_case('RGBCurve', 'Color'), curve_case('VectorCurve', 'Vector'),
              curve_case('FloatCurve', 'Value')]
    return cases


def ramp_case(interpolation):
    def build(nodes, links):
        ramp = nodes.new('ShaderNodeValToRGB')
        ramp.color_ramp.interpolation = interpolation
        ramp.color_ramp.elements[0].color = (1, 0, 0, 1)
        ramp.color_ramp.elements.new(0.4).color = (0, 0.5, 1, 0.5)
        compat.find_socket(ramp.inputs, 'Fac').default_value = 0.617
        return ramp.outputs[0]

    return Case(f'ramp {interpolation}', build)


def curve_case(kind, name):
    def build(nodes, links):
        node = nodes.new('ShaderNode' + kind)
        for index, curve in enumerate(node.mapping.curves):
            curve.points.new(0.3, 0.6 - 0.1 * index)
        node.mapping.update()
        fill(node, random.Random(kind), 0.1, 0.9)
        return node.outputs[0]

    return Case(f'curve {kind}', build)


def add_quad(case, column, row):
    """Add a quad whose material shows the case; negative numbers are shifted into view."""
    material = bpy.data.materials.new(case.name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    shown = case.build(tree.nodes, tree.links)
    scaled = tree.nodes.new('ShaderNodeVectorMath')
    scaled.operation = 'MULTIPLY_ADD'
    scaled.inputs[1].default_value = (0.05, 0.05, 0.05)
    scaled.inputs[2].default_value = (1.0, 1.0, 1.0)
    shine, output = (tree.nodes.new('ShaderNode' + n) for n in ('Emission', 'OutputMaterial'))
    tree.links.new(shown, scaled.inputs[0])
    tree.links.new(scaled.outputs[0], shine.inputs['Color'])
    tree.links.new(shine.outputs[0], output.inputs['Surface'])
    mesh = bpy.data.meshes.new(case.name)
    mesh.from_pydata([(0, 0, 0), (1, 0, 0), (1, 1, 0.4), (0, 1, 0.4)], [], [(0, 1, 2, 3)])
    mesh.uv_layers.new().data.foreach_set('uv', np.float32([0, 0, 1, 0, 1, 1, 0, 1]))
    mesh.materials.append(material)
    thing = bpy.data.objects.new(case.name, mesh)
    thing.location = (column, row, 0)
    # A light that nobody meets needs no program that tells how it shines on others.
    thing.visible_diffuse = thing.visible_glossy = thing.visible_transmission = False
    bpy.context.scene.collection.objects.link(thing)


def test_value_nodes_give_the_numbers_that_cycles_gives(scene, native_module, tmp_path):
    native.use_factory(None)
    cases = make_cases()
    side = math.ceil(math.sqrt(len(cases)))
    for index, case in enumerate(cases):
        add_quad(case, index % side, index // side)
    scene.camera.data.type = 'ORTHO'
    scene.camera.data.ortho_scale = side
    scene.camera.location = (side / 2, side / 2, 10)
    scene.render.resolution_x = scene.render.resolution_y = side * PIXELS
    scene.render.filter_size = 0.01
    ours = render_combined(scene, tmp_path)

    scene.render.engine = 'CYCLES'
    scene.cycles.samples = 1
    scene.cycles.use_denoising = scene.cycles.use_adaptive_sampling = False
    scene.cycles.filter_width = 0.01
    theirs = render_combined(scene, tmp_path)

    wrong = []
    for index, case in enumerate(cases):
        # Rows of the picture run downwards.
        row = (side - 1 - index // side) * PIXELS + PIXELS // 2
        column = index % side * PIXELS + PIXELS // 2
        mine, reference = ((picture[row, column, :3].astype(float) - 1.0) / 0.05
                           for picture in (ours, theirs))
        # Cycles does not show negative light.
        visible = reference > -19.9
        tolerance = 0.004 * np.maximum(np.abs(reference), 1.0)
        if not (np.abs(mine - reference) <= tolerance)[visible].all():
            wrong.append(f'{case.name}: {mine} instead of {reference}')
    assert not wrong, '\n' + '\n'.join(wrong)
