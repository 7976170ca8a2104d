# SPDX-License-Identifier: GPL-3.0-or-later
"""Whatever an artist builds arrives: once, in its place, with its materials."""

import math

import bpy
import numpy as np
import pytest

from building import Sync, add_object, cube, material_reading, quad
from panoptes import compat


@pytest.fixture
def sync(scene, recorder):
    return Sync(recorder)


def meshes(sync):
    """The meshes sent, by name, as (positions, triangles)."""
    return {a[1]: (a[2], a[3]) for a in sync.recorder.arguments('set_mesh')}


def instances(sync):
    """The last list of instances: (mesh ids, matrices, offsets, table, visibility)."""
    return sync.recorder.arguments('set_instances')[-1]


def node_group(build):
    """A geometry node group; `build(tree, input, output)` gets the sockets of its geometry."""
    tree = bpy.data.node_groups.new('Geometry', 'GeometryNodeTree')
    if compat.VERSION >= (4, 0, 0):
        tree.interface.new_socket('Geometry', in_out='INPUT', socket_type='NodeSocketGeometry')
        tree.interface.new_socket('Geometry', in_out='OUTPUT', socket_type='NodeSocketGeometry')
    else:
        tree.inputs.new('NodeSocketGeometry', 'Geometry')
        tree.outputs.new('NodeSocketGeometry', 'Geometry')
    build(tree, tree.nodes.new('NodeGroupInput').outputs[0], tree.nodes.new('NodeGroupOutput').inputs[0])
    return tree


def grid_of(tree, geometry, columns, rows=1):
    """Add nodes that put a geometry socket on the points of a grid; return their output."""
    grid = tree.nodes.new('GeometryNodeMeshGrid')
    grid.inputs['Vertices X'].default_value, grid.inputs['Vertices Y'].default_value = columns, rows
    grid.inputs['Size X'].default_value = columns
    points = tree.nodes.new('GeometryNodeInstanceOnPoints')
    tree.links.new(grid.outputs['Mesh'], points.inputs['Points'])
    tree.links.new(geometry, points.inputs['Instance'])
    return points.outputs[0]


def object_info(tree, thing):
    node = tree.nodes.new('GeometryNodeObjectInfo')
    node.inputs['Object'].default_value = thing
    node.inputs['As Instance'].default_value = True
    return node.outputs['Geometry']


class TestModifiers:
    """What deforms or makes geometry."""

    @pytest.mark.parametrize('kind, triangles', [
        ('SUBSURF', 48), ('ARRAY', 24), ('MIRROR', 24), ('TRIANGULATE', 12), ('SOLIDIFY', 24)])
    def test_counts(self, sync, kind, triangles):
        cube().modifiers.new('Modifier', kind)
        sync.run()
        assert len(meshes(sync)['Cube'][1]) == triangles

    def test_boolean(self, sync):
        cutter = cube()
        cutter.location, cutter.name = (1, 1, 1), 'Cutter'
        thing = cube()
        modifier = thing.modifiers.new('Boolean', 'BOOLEAN')
        modifier.object = cutter
        cutter.hide_set(True)
        cutter.hide_render = True
        sync.run()
        positions, _ = meshes(sync)[thing.name]
        assert list(meshes(sync)) == [thing.name]
        assert any(np.allclose(p, (0, 0, 0), atol=1e-5) for p in positions)
        assert not any(np.allclose(p, (1, 1, 1), atol=1e-5) for p in positions)

    def test_shape_key(self, sync):
        thing = cube()
        thing.shape_key_add(name='Basis')
        key = thing.shape_key_add(name='Key')
        key.data[0].co = (-7, 0, 0)
        key.value = 1
        sync.run()
        assert (-7, 0, 0) in map(tuple, meshes(sync)['Cube'][0])

    def test_armature(self, sync):
        thing = cube()
        bpy.ops.object.armature_add()
        armature = bpy.context.object
        group = thing.vertex_groups.new(name='Bone')
        group.add(range(8), 1.0, 'REPLACE')
        thing.modifiers.new('Armature', 'ARMATURE').object = armature
        armature.pose.bones['Bone'].location = (0, 5, 0)
        sync.run()
        assert meshes(sync)['Cube'][0][:, 2].min() == pytest.approx(4, abs=1e-5)


class TestNormals:
    """Split and custom normals."""

    def test_sharp_edges_split(self, sync):
        thing = cube()
        mesh = thing.data
        mesh.polygons.foreach_set('use_smooth', np.ones(6, bool))
        if compat.VERSION < (4, 1, 0):
            mesh.use_auto_smooth, mesh.auto_smooth_angle = True, math.pi
        for edge in mesh.edges:
            edge.use_edge_sharp = all(mesh.vertices[v].co.z > 0 for v in edge.vertices)
        mesh.update()
        sync.run()
        arguments = sync.recorder.arguments('set_mesh')[0]
        order = compat.loop_vertices(mesh)
        top = arguments[2][order][:, 2] > 0
        flat_on_top = np.isclose(arguments[6][:, 2], 1.0)
        # The lid's four corners alone point straight up; below, normals stay shared by three faces.
        assert flat_on_top.sum() == 4 and (flat_on_top <= top).all()
        assert np.allclose(np.abs(arguments[6][~top]), 1 / math.sqrt(3), atol=1e-3)

    def test_custom(self, sync):
        mesh = quad()
        if compat.VERSION < (4, 1, 0):
            mesh.use_auto_smooth = True
        mesh.polygons[0].use_smooth = True
        mesh.normals_split_custom_set([(0.6, 0, 0.8)] * 4)
        add_object(mesh)
        sync.run()
        assert np.allclose(sync.recorder.arguments('set_mesh')[0][6], (0.6, 0, 0.8), atol=1e-3)

    def test_negative_scale_keeps_the_matrix(self, sync):
        add_object(quad(), scale=(-2, 1, 1))
        sync.run()
        assert np.linalg.det(instances(sync)[1][0]) == pytest.approx(-2)


class TestAttributes:
    """Numbers that materials read by name."""

    @pytest.mark.parametrize('domain, expected', [
        ('POINT', [5, 5, 5, 1]), ('CORNER', [5, 5, 5, 1]), ('FACE', [5, 5, 5, 1])])
    def test_domains(self, sync, domain, expected):
        mesh = quad()
        layer = mesh.attributes.new('height', 'FLOAT', domain)
        layer.data.foreach_set('value', np.full(len(layer.data), 5, np.float32))
        mesh.materials.append(material_reading('height'))
        add_object(mesh)
        sync.run()
        assert np.array_equal(sync.recorder.arguments('set_mesh')[0][7]['height'], [expected] * 4)

    @pytest.mark.parametrize('kind, field, value, expected', [
        ('INT', 'value', -3, (-3, -3, -3, 1)), ('BOOLEAN', 'value', True, (1, 1, 1, 1)),
        ('INT8', 'value', 7, (7, 7, 7, 1)), ('FLOAT_VECTOR', 'vector', (1, 2, 3), (1, 2, 3, 1)),
        ('FLOAT2', 'vector', (1, 2), (1, 2, 0, 1))])
    def test_types(self, sync, kind, field, value, expected):
        mesh = quad()
        for element in mesh.attributes.new('named', kind, 'POINT').data:
            setattr(element, field, value)
        mesh.materials.append(material_reading('named'))
        add_object(mesh)
        sync.run()
        assert np.array_equal(sync.recorder.arguments('set_mesh')[0][7]['named'], [expected] * 4)

    def test_only_what_is_read(self, sync):
        mesh = quad()
        for name in ('read', 'unread'):
            mesh.attributes.new(name, 'FLOAT', 'POINT')
        mesh.attributes.new('edges', 'FLOAT', 'EDGE')
        mesh.materials.append(material_reading('read'))
        add_object(mesh)
        other = quad('Other', materials=1)
        other.attributes.new('read', 'FLOAT', 'POINT')
        add_object(other, 'Other')
        _, report = sync.run()
        attributes = {a[1]: set(a[7]) for a in sync.recorder.arguments('set_mesh')}
        assert attributes == {'Object': {'read'}, 'Other': set()} and report.meshes_extracted == 2

    def test_nodes_deliver_attributes_too(self, sync):
        def build(tree, source, target):
            store = tree.nodes.new('GeometryNodeStoreNamedAttribute')
            store.inputs['Name'].default_value = 'made'
            next(s for s in store.inputs if s.name == 'Value' and s.enabled).default_value = 0.25
            tree.links.new(source, store.inputs['Geometry'])
            tree.links.new(store.outputs[0], target)

        mesh = quad()
        mesh.materials.append(material_reading('made'))
        add_object(mesh).modifiers.new('Nodes', 'NODES').node_group = node_group(build)
        sync.run()
        assert np.array_equal(sync.recorder.arguments('set_mesh')[0][7]['made'],
                              [(0.25, 0.25, 0.25, 1)] * 4)


class TestInstances:
    """Every kind of instance."""

    def test_nested_collections(self, sync):
        inner = bpy.data.collections.new('Inner')
        inner.objects.link(bpy.data.objects.new('Leaf', quad()))
        outer = bpy.data.collections.new('Outer')
        for x in (0, 10):
            empty = bpy.data.objects.new('Branch', None)
            empty.instance_type, empty.instance_collection, empty.location = 'COLLECTION', inner, (x, 0, 0)
            outer.objects.link(empty)
        for y in (0, 100, 200):
            add_object(None, instance_type='COLLECTION', instance_collection=outer, location=(0, y, 0))
        sync.run()
        assert len(meshes(sync)) == 1
        places = sorted(tuple(m[:2, 3].tolist()) for m in instances(sync)[1])
        assert places == [(x, y) for x in (0, 10) for y in (0, 100, 200)]

    def test_instances_by_vertices(self, sync):
        parent = add_object(quad('Parent'), 'Parent', instance_type='VERTS',
                            show_instancer_for_viewport=False)
        add_object(quad('Child'), 'Child', parent=parent)
        sync.run()
        # The instancer itself is switched off; its child stands at home and on each vertex.
        assert list(meshes(sync)) == ['Child'] and len(instances(sync)[0]) == 5

    @pytest.mark.parametrize('shown', [True, False])
    def test_particles_of_an_object(self, sync, shown):
        leaf = add_object(quad('Leaf'), 'Leaf')
        emitter = cube()
        modifier = emitter.modifiers.new('Particles', 'PARTICLE_SYSTEM')
        settings = modifier.particle_system.settings
        settings.type, settings.count = 'HAIR', 50
        settings.render_type, settings.instance_object = 'OBJECT', leaf
        emitter.show_instancer_for_viewport = shown
        _, report = sync.run()
        ids = instances(sync)[0]
        assert sorted(np.unique(ids, return_counts=True)[1]) == ([1, 51] if shown else [51])
        assert report.warnings == [] and len(meshes(sync)) == 1 + shown

    def test_particles_of_a_collection(self, sync):
        leaves = bpy.data.collections.new('Leaves')
        for name in 'AB':
            leaves.objects.link(bpy.data.objects.new(name, quad(name)))
        settings = cube().modifiers.new('Particles', 'PARTICLE_SYSTEM').particle_system.settings
        settings.type, settings.count = 'HAIR', 40
        settings.render_type, settings.instance_collection = 'COLLECTION', leaves
        sync.run()
        assert set(meshes(sync)) == {'A', 'B', 'Cube'} and len(instances(sync)[0]) == 41

    def test_hair_is_named(self, sync):
        settings = cube().modifiers.new('Particles', 'PARTICLE_SYSTEM').particle_system.settings
        settings.type, settings.render_type = 'HAIR', 'PATH'
        _, report = sync.run()
        assert len(report.warnings) == 1 and "'Cube'" in report.warnings[0]
        assert 'hair' in report.warnings[0] and len(instances(sync)[0]) == 1

    def test_nodes_instance_an_object(self, sync):
        leaf = add_object(quad('Leaf', materials=1), 'Leaf')

        def build(tree, source, target):
            tree.links.new(grid_of(tree, object_info(tree, leaf), 5), target)

        add_object(quad('Ground'), 'Ground').modifiers.new('Nodes', 'NODES').node_group = node_group(build)
        sync.run()
        ids, matrices, offsets, table, *_ = instances(sync)
        assert list(meshes(sync)) == ['Leaf'] and len(ids) == 6
        assert len({tuple(m[:3, 3]) for m in matrices[1:]}) == 5
        assert all(table[offset] > 0 for offset in offsets)

    def test_realised_instances_are_one_mesh(self, sync):
        leaf = add_object(quad('Leaf'), 'Leaf')

        def build(tree, source, target):
            realize = tree.nodes.new('GeometryNodeRealizeInstances')
            tree.links.new(grid_of(tree, object_info(tree, leaf), 5), realize.inputs[0])
            tree.links.new(realize.outputs[0], target)

        add_object(quad('Ground'), 'Ground').modifiers.new('Nodes', 'NODES').node_group = node_group(build)
        sync.run()
        assert len(meshes(sync)['Ground'][1]) == 10 and len(instances(sync)[0]) == 2

    def test_geometry_made_by_nodes_and_instanced(self, sync):
        material = bpy.data.materials.new('Made')

        def build(tree, source, target):
            made = tree.nodes.new('GeometryNodeMeshCube')
            paint = tree.nodes.new('GeometryNodeSetMaterial')
            paint.inputs['Material'].default_value = material
            join = tree.nodes.new('GeometryNodeJoinGeometry')
            tree.links.new(made.outputs['Mesh'], paint.inputs['Geometry'])
            tree.links.new(grid_of(tree, paint.outputs[0], 7), join.inputs[0])
            tree.links.new(source, join.inputs[0])
            tree.links.new(join.outputs[0], target)

        add_object(quad('Ground'), 'Ground').modifiers.new('Nodes', 'NODES').node_group = node_group(build)
        sync.run()
        ids, _, offsets, table, *_ = instances(sync)
        assert sorted(np.unique(ids, return_counts=True)[1]) == [1, 7]
        slots = {a[0]: a[5].max() for a in sync.recorder.arguments('set_mesh')}
        assert len(slots) == 2
        painted = [table[offset + slots[mesh]] > 0 for mesh, offset in zip(ids, offsets)]
        assert sorted(painted) == [False] + [True] * 7

    def test_ten_thousand(self, sync):
        """Instances travel as matrices: one mesh, one call, and a move sends only what moved."""
        leaf = add_object(quad('Leaf'), 'Leaf')

        def build(tree, source, target):
            tree.links.new(grid_of(tree, object_info(tree, leaf), 100, 100), target)

        ground = add_object(quad('Ground'), 'Ground')
        ground.modifiers.new('Nodes', 'NODES').node_group = node_group(build)
        names, report = sync.run()
        assert names.count('set_mesh') == 1 and len(instances(sync)[0]) == 10_001
        ground.location.z = 2
        names, report = sync.run()
        assert names == ['set_instance_matrices'] and report.meshes_extracted == 0
        indices, matrices = sync.recorder.arguments('set_instance_matrices')[0]
        assert len(indices) == 10_000 and (matrices[:, 2, 3] == 2).all()

    def test_first_user_of_a_mesh_may_go(self, sync):
        """A mesh belongs to itself, not to the object that happened to show it first."""
        mesh = quad()
        first = add_object(mesh, 'A')
        add_object(mesh, 'B')
        sync.run()
        first.hide_set(True)
        names, report = sync.run()
        assert names == ['set_instances'] and report.meshes_extracted == 0


class TestShown:
    """What is hidden, and from whom."""

    def test_final_renders_and_viewports_differ(self, sync):
        add_object(quad('Shown'), 'Shown').hide_viewport = True
        add_object(quad('Rendered'), 'Rendered').hide_render = True
        sync.run()
        assert list(meshes(sync)) == ['Rendered']
        sync.recorder.clear()
        bpy.ops.render.render()
        assert [a[1] for a in sync.recorder.arguments('set_mesh')] == ['Shown']

    def test_excluded_collection(self, sync):
        extra = bpy.data.collections.new('Extra')
        bpy.context.scene.collection.children.link(extra)
        extra.objects.link(bpy.data.objects.new('Extra', quad()))
        sync.run()
        assert len(instances(sync)[0]) == 1
        bpy.context.view_layer.layer_collection.children['Extra'].exclude = True
        sync.run()
        assert len(instances(sync)[0]) == 0

    def test_local_view(self, sync):
        inside = bpy.data.collections.new('Inside')
        inside.objects.link(bpy.data.objects.new('Leaf', quad('Leaf')))
        for name in ('A', 'B'):
            thing = add_object(quad(name), name)
            maker = add_object(None, f'Maker {name}', instance_type='COLLECTION',
                               instance_collection=inside, location=(ord(name), 0, 0))
            for one in (thing, maker):
                one.select_set(name == 'A')
        bpy.context.view_layer.update()
        window = bpy.context.window_manager.windows[0]
        area = next(a for a in window.screen.areas if a.type == 'VIEW_3D')
        region = next(r for r in area.regions if r.type == 'WINDOW')
        with bpy.context.temp_override(window=window, area=area, region=region):
            bpy.ops.view3d.localview(frame_selected=False)
        space = area.spaces[0]
        assert space.local_view is not None
        depsgraph = bpy.context.evaluated_depsgraph_get()
        sync.scene_sync.sync(sync.mirror, depsgraph, space, incremental=False)
        assert set(meshes(sync)) == {'A', 'Leaf'}
        assert sorted(m[0, 3] for m in instances(sync)[1]) == [0, ord('A')]
        sync.recorder.clear()
        sync.scene_sync.sync(sync.mirror, depsgraph, None, incremental=False)
        assert list(meshes(sync)) == ['B'] and len(instances(sync)[0]) == 4
