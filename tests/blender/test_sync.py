# SPDX-License-Identifier: GPL-3.0-or-later
"""Depsgraph -> native calls: what is sent, what is not, and what is refused."""

import math

import bpy
import numpy as np
import pytest

from building import Sync, add_object, cube, quad
from panoptes import compat
from panoptes.sync import SceneSync


@pytest.fixture
def sync(scene, recorder):
    return Sync(recorder)


class TestMeshes:
    """Extraction of geometry."""

    def test_quad(self, sync):
        mesh = quad()
        uv = mesh.uv_layers.new(name='Map')
        uv.data.foreach_set('uv', np.arange(8, dtype=np.float32))
        add_object(mesh)
        sync.run()
        (arguments,) = sync.recorder.arguments('set_mesh')
        _, name, positions, vertices, loops, slots, normals, attributes, uv_name, color, space = arguments
        assert name == 'Object'
        assert positions.dtype == normals.dtype == np.float32
        assert vertices.dtype == loops.dtype == slots.dtype == np.int32
        assert positions.shape == (4, 3) and vertices.shape == loops.shape == (2, 3)
        assert np.allclose(normals, (0, 0, 1)) and normals.shape == (4, 3)
        assert sorted(set(vertices.flat)) == [0, 1, 2, 3]
        assert np.array_equal(attributes['Map'].reshape(-1), np.arange(8))
        assert uv_name == 'Map' and color == '' and space == ((0, 0, -1), (1, 1, 1))
        for array in (positions, vertices, loops, slots, normals):
            assert array.flags.c_contiguous

    def test_color_attributes_become_linear_loops(self, sync):
        mesh = quad()
        point = mesh.color_attributes.new('Point', 'FLOAT_COLOR', 'POINT')
        corner = mesh.color_attributes.new('Corner', 'BYTE_COLOR', 'CORNER')
        colors = np.linspace(0, 1, 16, dtype=np.float32)
        point.data.foreach_set('color', colors)
        corner.data.foreach_set('color', np.tile(np.float32([0.2, 0.2, 0.2, 1]), 4))
        add_object(mesh)
        sync.run()
        attributes = sync.recorder.arguments('set_mesh')[0][7]
        order = compat.loop_vertices(mesh)
        assert np.allclose(attributes['Point'], colors.reshape(4, 4)[order])
        assert np.allclose(attributes['Corner'][:, :3], 0.2, atol=0.005)

    def test_flat_and_smooth_normals(self, sync):
        thing = cube()
        sync.run()
        normals = sync.recorder.arguments('set_mesh')[0][6]
        assert np.allclose(np.abs(normals).max(axis=1), 1.0)
        thing.data.polygons.foreach_set('use_smooth', np.ones(6, bool))
        thing.data.update()
        sync.run()
        normals = sync.recorder.arguments('set_mesh')[0][6]
        assert np.allclose(np.abs(normals), 1 / math.sqrt(3), atol=1e-3)

    def test_modifier_counts(self, sync):
        cube().modifiers.new('Subdivision', 'SUBSURF').levels = 1
        sync.run()
        assert len(sync.recorder.arguments('set_mesh')[0][3]) == 48

    def test_materials_by_face_and_slot(self, sync):
        mesh = quad(materials=2)
        mesh.polygons[0].material_index = 1
        thing = add_object(mesh)
        thing.material_slots[1].link = 'OBJECT'
        thing.material_slots[1].material = bpy.data.materials.new('Own')
        sync.run()
        assert sync.recorder.arguments('set_mesh')[0][5].tolist() == [1, 1]
        names = [a[1] for a in sync.recorder.arguments('set_material')]
        assert sorted(names) == ['Material', 'Own']
        _, _, offsets, table, *_ = sync.recorder.arguments('set_instances')[0]
        assert offsets.tolist() == [0] and len(table) == 2 and len(set(table)) == 2

    def test_slot_that_does_not_exist_is_the_last_one(self, sync):
        mesh = quad(materials=2)
        mesh.polygons[0].material_index = 5
        add_object(mesh)
        sync.run()
        assert sync.recorder.arguments('set_mesh')[0][5].tolist() == [1, 1]

    def test_no_material_is_number_zero(self, sync):
        add_object(quad())
        sync.run()
        assert sync.recorder.arguments('set_instances')[0][3].tolist() == [0]

    @pytest.mark.parametrize('kind', ['CURVE', 'TEXT', 'META', 'SURFACE'])
    def test_other_geometry_types(self, sync, kind):
        if kind == 'CURVE':
            bpy.ops.curve.primitive_bezier_circle_add()
            bpy.context.object.data.bevel_depth = 0.1
        elif kind == 'TEXT':
            bpy.ops.object.text_add()
        elif kind == 'META':
            bpy.ops.object.metaball_add()
            bpy.ops.object.metaball_add(location=(0.5, 0, 0))
        else:
            bpy.ops.surface.primitive_nurbs_surface_sphere_add()
        sync.run()
        assert sync.recorder.names().count('set_mesh') == 1
        assert len(sync.recorder.arguments('set_instances')[0][0]) == 1
        assert len(sync.recorder.arguments('set_mesh')[0][3]) > 4

    def test_edit_mode(self, sync):
        cube()
        bpy.ops.object.mode_set(mode='EDIT')
        sync.run()
        assert len(sync.recorder.arguments('set_mesh')[0][3]) == 12
        bpy.ops.object.mode_set(mode='OBJECT')

    def test_empty_mesh_is_left_out(self, sync):
        add_object(bpy.data.meshes.new('Nothing'))
        sync.run()
        assert 'set_mesh' not in sync.recorder.names()
        assert len(sync.recorder.arguments('set_instances')[0][0]) == 0


class TestBadGeometry:
    """What is not a number is named and left out."""

    def test_nan_vertex(self, sync):
        mesh = bpy.data.meshes.new('Mesh')
        mesh.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0), (math.nan, 0, 0), (2, math.inf, 0),
                          (2, 2, 0)], [], [(0, 1, 2), (3, 4, 5)])
        add_object(mesh, 'Broken')
        _, report = sync.run()
        arguments = sync.recorder.arguments('set_mesh')[0]
        assert len(arguments[3]) == 1 and np.isfinite(arguments[2]).all()
        assert len(report.warnings) == 1 and "'Broken'" in report.warnings[0]
        assert '2 vertices' in report.warnings[0]
        # The warning stays as long as the mesh does, also when it is not read again.
        _, report = sync.run()
        assert len(report.warnings) == 1 and report.meshes_extracted == 0

    def test_nothing_left(self, sync):
        mesh = quad()
        mesh.vertices.foreach_set('co', np.full(12, math.nan, np.float32))
        add_object(mesh)
        _, report = sync.run()
        assert 'set_mesh' not in sync.recorder.names() and len(report.warnings) == 1

    def test_nan_uv_and_normal(self, sync):
        mesh = quad()
        mesh.uv_layers.new(name='Map').data.foreach_set('uv', np.full(8, math.nan, np.float32))
        add_object(mesh)
        sync.run()
        assert np.isfinite(sync.recorder.arguments('set_mesh')[0][7]['Map']).all()

    def test_nan_matrix(self, sync):
        add_object(quad(), 'Good')
        add_object(quad(), 'Lost', location=(math.nan, 0, 0))
        _, report = sync.run()
        assert len(sync.recorder.arguments('set_instances')[0][0]) == 1
        assert len(report.warnings) == 1 and "'Lost'" in report.warnings[0]


class TestInstances:
    """Instances and their matrices."""

    def test_matrix_is_row_major(self, sync):
        add_object(quad(), location=(1, 2, 3))
        sync.run()
        matrix = sync.recorder.arguments('set_instances')[0][1][0]
        assert matrix[:3, 3].tolist() == [1, 2, 3] and matrix.dtype == np.float32

    def test_shared_mesh_is_sent_once(self, sync):
        mesh = quad()
        for x in range(3):
            add_object(mesh, location=(x, 0, 0))
        sync.run()
        assert sync.recorder.names().count('set_mesh') == 1
        ids = sync.recorder.arguments('set_instances')[0][0]
        assert len(ids) == 3 and len(set(ids)) == 1

    def test_collection_instances(self, sync):
        hidden = bpy.data.collections.new('Collection')
        hidden.objects.link(bpy.data.objects.new('Inside', quad()))
        for x in range(4):
            add_object(None, instance_type='COLLECTION', instance_collection=hidden,
                       location=(x, 0, 0))
        sync.run()
        assert sync.recorder.names().count('set_mesh') == 1
        assert len(sync.recorder.arguments('set_instances')[0][0]) == 4

    def test_same_mesh_with_other_materials(self, sync):
        mesh = quad(materials=1)
        add_object(mesh)
        other = add_object(mesh)
        other.material_slots[0].link = 'OBJECT'
        other.material_slots[0].material = bpy.data.materials.new('Other')
        sync.run()
        ids, _, offsets, table, *_ = sync.recorder.arguments('set_instances')[0]
        assert ids[0] == ids[1]
        assert table[offsets[0]] != table[offsets[1]]

    def test_hidden_objects(self, sync):
        add_object(quad()).hide_viewport = True
        add_object(quad()).hide_set(True)
        sync.run()
        assert len(sync.recorder.arguments('set_instances')[0][0]) == 0

    def test_lights(self, sync):
        light = bpy.data.lights.new('Lamp', 'SPOT')
        light.energy, light.color = 100.0, (1.0, 0.5, 0.25)
        light.spot_size, light.spot_blend, light.shadow_soft_size = 1.0, 0.5, 0.125
        add_object(light, location=(0, 0, 5))
        sync.run()
        (found,) = sync.recorder.arguments('set_lights')[0][0]
        assert found['type'] == 'SPOT' and found['energy'] == 100.0
        assert found['color'] == pytest.approx((1.0, 0.5, 0.25))
        assert found['radius'] == 0.125 and found['spot_blend'] == 0.5
        assert found['matrix'][2, 3] == 5.0 and found['cast_shadow']


class TestChanges:
    """What an edit uploads."""

    def test_nothing(self, sync):
        cube()
        sync.run()
        names, report = sync.run()
        assert names == [] and report.meshes_extracted == 0 and report.materials_compiled == 0

    def test_full_sync_without_change_sends_nothing(self, sync):
        add_object(quad(materials=1))
        sync.full()
        names, report = sync.full()
        assert names == [] and report.meshes_extracted == 1

    def test_camera_move(self, sync):
        cube()
        sync.run()
        bpy.context.scene.camera.location.x = 3
        assert sync.run()[0] == []

    def test_object_move(self, sync):
        things = [add_object(quad()) for _ in range(3)]
        sync.run()
        things[1].location.x = 5
        names, report = sync.run()
        assert names == ['set_instance_matrices'] and report.meshes_extracted == 0
        indices, matrices = sync.recorder.arguments('set_instance_matrices')[0]
        assert indices.tolist() == [1] and matrices[0, 0, 3] == 5

    def test_mesh_edit(self, sync):
        first, _ = cube(), add_object(quad())
        sync.run()
        first.data.vertices[0].co.x = -3
        first.data.update()
        names, report = sync.run()
        assert names == ['set_mesh'] and report.meshes_extracted == 1

    def test_modifier_value(self, sync):
        modifier = cube().modifiers.new('Subdivision', 'SUBSURF')
        sync.run()
        modifier.levels = 2
        assert sync.run()[0] == ['set_mesh']

    def test_material_value(self, sync):
        mesh = quad(materials=1)
        mesh.materials[0].use_nodes = True
        add_object(mesh)
        add_object(quad(materials=1))
        sync.run()
        node = next(n for n in mesh.materials[0].node_tree.nodes if n.type == 'BSDF_PRINCIPLED')
        node.inputs['Roughness'].default_value = 0.123
        names, report = sync.run()
        assert names == ['set_material_params'] and report.meshes_extracted == 0

    def test_material_link(self, sync):
        mesh = quad(materials=1)
        mesh.materials[0].use_nodes = True
        add_object(mesh)
        sync.run()
        tree = mesh.materials[0].node_tree
        node = next(n for n in tree.nodes if n.type == 'BSDF_PRINCIPLED')
        tree.links.new(tree.nodes.new('ShaderNodeNewGeometry').outputs[0], node.inputs['Base Color'])
        assert sync.run()[0] == ['set_material']

    def test_light_energy(self, sync):
        light = bpy.data.lights.new('Lamp', 'POINT')
        add_object(light)
        sync.run()
        light.energy = 123
        assert sync.run()[0] == ['set_lights']

    def test_world_color(self, sync):
        world = bpy.context.scene.world = bpy.data.worlds.new('World')
        world.use_nodes = True
        node = next(n for n in world.node_tree.nodes if n.type == 'BACKGROUND')
        sync.run()
        node.inputs['Strength'].default_value = 3.0
        assert sync.run()[0] == ['set_world']

    def test_add_and_delete(self, sync):
        cube()
        sync.run()
        thing = add_object(quad())
        names, report = sync.run()
        assert names == ['set_mesh', 'set_instances'] and report.meshes_extracted == 1
        bpy.data.objects.remove(thing)
        assert sync.run()[0] == ['set_instances', 'remove_mesh']

    def test_hide(self, sync):
        first, _ = cube(), add_object(quad())
        sync.run()
        first.hide_set(True)
        assert sync.run()[0] == ['set_instances', 'remove_mesh']

    def test_frame_change(self, sync):
        thing = cube()
        thing.keyframe_insert('location', frame=1)
        thing.location.x = 4
        thing.keyframe_insert('location', frame=10)
        bpy.context.scene.frame_set(1)
        sync.run()
        assert sync.run(frame=10)[0] == ['set_instance_matrices']

    def test_frame_change_of_a_deforming_mesh(self, sync):
        thing = cube()
        thing.shape_key_add(name='Basis')
        key = thing.shape_key_add(name='Key')
        key.data[0].co.x = -5
        key.value = 0
        key.keyframe_insert('value', frame=1)
        key.value = 1
        key.keyframe_insert('value', frame=10)
        bpy.context.scene.frame_set(1)
        sync.run()
        assert sync.run(frame=10)[0] == ['set_mesh']

    def test_another_writer_forces_a_full_pass(self, sync):
        cube()
        sync.run()
        other = SceneSync()
        other.sync(sync.mirror, bpy.context.evaluated_depsgraph_get(), incremental=False)
        names, report = sync.run()
        assert report.meshes_extracted == 1 and names == []

    def test_ids_are_stable(self, sync):
        mesh = quad()
        add_object(mesh)
        sync.run()
        before = sync.recorder.arguments('set_mesh')[0][0]
        mesh.vertices[0].co.x = -2
        mesh.update()
        sync.run()
        assert sync.recorder.arguments('set_mesh')[0][0] == before > 0
