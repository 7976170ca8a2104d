# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading meshes from Blender's memory gives the bits that foreach_get gives."""

import math

import bmesh
import bpy
import numpy as np
import pytest

from building import add_object, quad
from panoptes import compat
from panoptes.sync import memory, meshes

WANTED = ('float', 'int', 'int8', 'bool', 'vector', 'pair', 'face')


@pytest.fixture
def both(scene, native_module, monkeypatch):
    """A function that extracts an object in both ways: (native mesh or None, arrays' mesh or None,
    warnings of each)."""

    def extract(thing):
        bpy.context.view_layer.update()
        evaluated = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
        slots = max(1, len(thing.material_slots))
        told, told_slowly = [], []
        fast = meshes.extract(evaluated, slots, WANTED, told.append)
        with monkeypatch.context() as patch:
            patch.setattr(memory, 'read', lambda *arguments, **named: None)
            slow = meshes.extract(evaluated, slots, WANTED, told_slowly.append)
        assert fast.available == slow.available and fast.delivered == slow.delivered
        assert isinstance(slow.mesh, (meshes.MeshArrays, type(None)))
        made = slow.mesh and native_module.make_mesh(*slow.mesh.arguments())
        return fast.mesh, made, told, told_slowly

    return extract


def monkey():
    bpy.ops.mesh.primitive_monkey_add()
    return bpy.context.object


def flat():
    return monkey()


def smooth():
    thing = monkey()
    thing.data.polygons.foreach_set('use_smooth', np.ones(len(thing.data.polygons), bool))
    return thing


def some_smooth():
    thing = monkey()
    thing.data.polygons.foreach_set('use_smooth', np.arange(len(thing.data.polygons)) % 3 == 0)
    return thing


def auto_smooth():
    thing = smooth()
    thing.data.use_auto_smooth, thing.data.auto_smooth_angle = True, 0.5
    return thing


def sharp_edges():
    thing = auto_smooth()
    thing.data.auto_smooth_angle = math.pi
    thing.data.edges.foreach_set('use_edge_sharp', np.arange(len(thing.data.edges)) % 5 == 0)
    return thing


def custom_normals():
    thing = auto_smooth()
    random = np.random.default_rng(1).normal(size=(len(thing.data.loops), 3))
    thing.data.normals_split_custom_set((random / np.linalg.norm(random, axis=1)[:, None]).tolist())
    return thing


def n_gons():
    bpy.ops.mesh.primitive_cylinder_add(vertices=13)
    return bpy.context.object


def uv_maps():
    thing = monkey()
    for name in ('Second', 'Third'):
        layer = thing.data.uv_layers.new(name=name)
        layer.data.foreach_set('uv', np.random.default_rng(2).random(
            2 * len(thing.data.loops), np.float32))
    layer.active_render = True
    return thing


def colors():
    thing = monkey()
    random = np.random.default_rng(3)
    for domain in ('POINT', 'CORNER'):
        for kind in ('BYTE_COLOR', 'FLOAT_COLOR'):
            layer = thing.data.color_attributes.new(f'{kind} {domain}', kind, domain)
            layer.data.foreach_set('color', random.random(4 * len(layer.data), np.float32))
    thing.data.color_attributes.render_color_index = 2
    return thing


def byte_colors_of_every_code():
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=16, y_subdivisions=16)
    mesh = bpy.context.object.data
    layer = mesh.color_attributes.new('Codes', 'BYTE_COLOR', 'POINT')
    codes = np.repeat(np.arange(len(layer.data)) % 256, 4) / np.float32(255.0)
    layer.data.foreach_set('color_srgb', codes.astype(np.float32))
    return bpy.context.object


def attributes():
    thing = monkey()
    random = np.random.default_rng(4)
    for name, kind, domain, field, width in (
            ('float', 'FLOAT', 'POINT', 'value', 1), ('int', 'INT', 'CORNER', 'value', 1),
            ('int8', 'INT8', 'POINT', 'value', 1), ('bool', 'BOOLEAN', 'FACE', 'value', 1),
            ('vector', 'FLOAT_VECTOR', 'POINT', 'vector', 3), ('pair', 'FLOAT2', 'CORNER', 'vector', 2),
            ('face', 'FLOAT', 'FACE', 'value', 1), ('edge', 'FLOAT', 'EDGE', 'value', 1),
            ('unwanted', 'FLOAT', 'POINT', 'value', 1)):
        layer = thing.data.attributes.new(name, kind, domain)
        values = random.normal(size=width * len(layer.data)) * 50
        layer.data.foreach_set(field, {'BOOLEAN': values > 0, 'INT': values.astype(np.int32),
                                       'INT8': values.astype(np.int32)}.get(
                                           kind, values.astype(np.float32)))
    return thing


def materials():
    thing = monkey()
    for index in range(3):
        thing.data.materials.append(bpy.data.materials.new(f'Material {index}'))
    # One more than there are slots.
    thing.data.polygons.foreach_set('material_index', np.arange(len(thing.data.polygons)) % 4)
    return thing


def broken():
    thing = smooth()
    thing.data.uv_layers.active.data[5].uv = (math.nan, math.inf)
    thing.data.vertices[3].co.x = math.nan
    thing.data.vertices[100].co.z = -math.inf
    return thing


def nothing_but_broken():
    mesh = quad()
    mesh.vertices.foreach_set('co', np.full(12, math.nan, np.float32))
    return add_object(mesh)


def no_faces():
    mesh = bpy.data.meshes.new('Wire')
    mesh.from_pydata([(0, 0, 0), (1, 0, 0)], [(0, 1)], [])
    return add_object(mesh)


def loose_parts():
    thing = n_gons()
    edit = bmesh.new()
    edit.from_mesh(thing.data)
    edit.verts.new((9, 9, 9))
    edit.edges.new([edit.verts.new((8, 8, 8)), edit.verts.new((7, 7, 7))])
    edit.to_mesh(thing.data)
    edit.free()
    return thing


def zero_area():
    mesh = bpy.data.meshes.new('Sliver')
    mesh.from_pydata([(0, 0, 0), (1, 0, 0), (2, 0, 0), (1, 1, 0)], [], [(0, 1, 2), (0, 2, 3)])
    return add_object(mesh)


def one_triangle():
    mesh = bpy.data.meshes.new('Triangle')
    mesh.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [], [(0, 1, 2)])
    return add_object(mesh)


def subdivided():
    thing = auto_smooth()
    thing.modifiers.new('Subdivision', 'SUBSURF').levels = 2
    return thing


def mirrored_and_cut():
    thing = monkey()
    thing.modifiers.new('Mirror', 'MIRROR')
    bpy.ops.mesh.primitive_cube_add(size=1.0)
    cutter = bpy.context.object
    boolean = thing.modifiers.new('Boolean', 'BOOLEAN')
    boolean.object, boolean.solver = cutter, 'FAST'
    thing.modifiers.new('Array', 'ARRAY')
    return thing


def weighted_normals():
    thing = auto_smooth()
    thing.modifiers.new('Weighted Normal', 'WEIGHTED_NORMAL')
    return thing


def edit_mode():
    thing = colors()
    bpy.context.view_layer.objects.active = thing
    bpy.ops.object.mode_set(mode='EDIT')
    return thing


MAKERS = (flat, smooth, some_smooth, auto_smooth, sharp_edges, custom_normals, n_gons, uv_maps, colors,
          byte_colors_of_every_code, attributes, materials, broken, nothing_but_broken, no_faces,
          loose_parts, zero_area, one_triangle, subdivided, mirrored_and_cut, weighted_normals,
          edit_mode)
EMPTY = (nothing_but_broken, no_faces)
# What 4.1 did away with or made otherwise; the way through memory is for 3.4 alone.
ONLY_OLD = pytest.mark.skipif(compat.VERSION >= (3, 5, 0), reason='Blender 3.4 alone is read by pointer')


@ONLY_OLD
@pytest.mark.parametrize('make', MAKERS, ids=lambda make: make.__name__)
def test_same_bits(both, make):
    fast, slow, told, told_slowly = both(make())
    assert told == told_slowly
    if make in EMPTY:
        assert fast is None and slow is None
        return
    assert isinstance(fast, meshes.NativeMesh)
    assert fast.mesh.triangles == slow.triangles > 0
    assert fast.fingerprint == slow.fingerprint
    assert len(told) == (make is broken)


@ONLY_OLD
def test_fingerprints_tell_meshes_apart(both):
    """Each part of a mesh shows in its fingerprint, so that equal ones say something."""
    thing = colors()
    before = dict(both(thing)[0].fingerprint)
    mesh = thing.data

    def changed(edit):
        nonlocal before
        edit()
        mesh.update()
        after = dict(both(thing)[0].fingerprint)
        names = {name for name in after if after[name] != before[name]}
        before = after
        return names

    assert changed(lambda: None) == set()
    assert changed(lambda: mesh.polygons.foreach_set(
        'use_smooth', np.ones(len(mesh.polygons), bool))) == {'normals'}
    assert changed(lambda: setattr(mesh.uv_layers[0].data[7], 'uv', (5, 5))) == {'attributes'}
    assert changed(lambda: setattr(mesh.color_attributes[0].data[7], 'color', (1, 2, 3, 4))) == {
        'attributes'}
    assert changed(lambda: setattr(mesh.color_attributes, 'render_color_index', 1)) == {
        'default_color'}
    assert 'positions' in changed(lambda: setattr(mesh.vertices[5].co, 'x', 9.0))


@ONLY_OLD
@pytest.mark.parametrize('size', ['vertex', 'loop', 'polygon', 'triangle', 'UV'])
def test_unexpected_strides_are_refused(scene, native_module, monkeypatch, size):
    """A build of Blender with other structs is read by foreach_get."""
    thing = monkey()
    monkeypatch.setitem(memory._SIZES, size, memory._SIZES[size] + 4)
    evaluated = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    assert isinstance(meshes.extract(evaluated, 1, (), pytest.fail).mesh, meshes.MeshArrays)


@pytest.mark.parametrize('edit', [
    None,
    lambda a: a['loops'].__setitem__((1, 0), 3),
    lambda a: a['triangles'].__setitem__((0, 2), 3),
    lambda a: a['triangles'].__setitem__((0, 3), 1),
    lambda a: a.update(attribute=('Map', 'CORNER', 'UV', 2)),
    lambda a: a.update(attribute=('Map', 'CORNER', 'QUATERNION', 3)),
    lambda a: a.update(attribute=('Map', 'EDGE', 'FLOAT', 3)),
], ids=['sound', 'vertex', 'loop', 'polygon', 'short attribute', 'unknown type', 'unknown domain'])
def test_memory_that_is_no_mesh_is_refused(native_module, edit):
    """Indices never lead out of an array; such memory is refused instead of being read."""
    arrays = {
        'vertices': np.zeros((3, 4), np.float32),
        'loops': np.array([[0, 0], [1, 1], [2, 2]], np.uint32),
        'polygons': np.array([[0, 3, 0]], np.int32),
        'triangles': np.array([[0, 1, 2, 0]], np.uint32),
        'normals': np.ones((3, 3), np.float32),
        'map': np.ones((3, 3), np.float32),
        'attribute': ('Map', 'CORNER', 'UV', 3),
    }
    if edit:
        edit(arrays)
    blocks = {name: (arrays[name].ctypes.data, len(arrays[name]))
              for name in ('vertices', 'loops', 'polygons', 'triangles')}
    normals = arrays['normals'].ctypes.data
    name, domain, kind, count = arrays['attribute']
    found = native_module.read_mesh(
        name='Fake', **blocks, loop_normals=0, vertex_normals=normals, polygon_normals=normals,
        slots=0, slot_count=1, default_uv='', default_color='', texture_space=None,
        attributes=[(name, domain, kind, arrays['map'].ctypes.data, count)])
    assert (found is None) == (edit is not None)


def test_other_versions_use_arrays(scene, native_module, monkeypatch):
    monkeypatch.setattr(compat, 'VERSION', (4, 3, 2))
    thing = monkey()
    thing.data.calc_loop_triangles()
    assert memory.read(thing.data, 'Monkey', 1, [], {}) is None


@ONLY_OLD
def test_an_engine_takes_a_mesh_once(both, native_module):
    fast, _, _, _ = both(monkey())
    engine = native_module.Engine(True)
    try:
        engine.set_mesh(1, *fast.arguments())
        with pytest.raises(native_module.Error, match='twice'):
            engine.set_mesh(2, *fast.arguments())
    finally:
        engine.close()
