# SPDX-License-Identifier: GPL-3.0-or-later
"""After any edit, undo or redo, the scene that was kept by changes equals one read afresh."""

import bmesh
import bpy
import numpy as np
import pytest

from building import add_object, cube, material_reading, quad
from scene_state import Follower


@pytest.fixture(params=['memory', 'arrays'])
def stage(scene, request):
    """A small scene with something of everything that is edited; both ways of reading meshes."""
    request.getfixturevalue({'memory': 'native_module', 'arrays': 'arrays_only'}[request.param])
    first = cube()
    first.name = 'First'
    for name in ('Red', 'Green'):
        first.data.materials.append(bpy.data.materials.new(name))
        first.data.materials[-1].use_nodes = True
    shared = quad('Shared', materials=1)
    for x in range(3):
        add_object(shared, f'Quad {x}', location=(x, 0, 0))
    inner = bpy.data.collections.new('Inner')
    inner.objects.link(bpy.data.objects.new('Inside', quad('Inside')))
    add_object(None, 'Instancer', instance_type='COLLECTION', instance_collection=inner)
    extra = bpy.data.collections.new('Extra')
    scene.collection.children.link(extra)
    extra.objects.link(bpy.data.objects.new('Extra', quad('Extra')))
    add_object(bpy.data.lights.new('Lamp', 'POINT'), 'Lamp', location=(0, 0, 4))
    text = bpy.data.curves.new('Text', 'FONT')
    text.body = 'ab'
    add_object(text, 'Text')
    scene.world = bpy.data.worlds.new('World')
    scene.world.use_nodes = True
    bpy.context.view_layer.objects.active = first
    return scene


def things():
    return bpy.data.objects


def layer_collection(name):
    return bpy.context.view_layer.layer_collection.children[name]


def move():
    things()['First'].location.x += 1


def mirror():
    things()['Quad 1'].scale.x = -1


def add():
    add_object(quad(), 'New')


def add_user_of_a_mesh():
    add_object(bpy.data.meshes['Shared'], 'Another')


def delete():
    things().remove(things()['Quad 0'])


def delete_and_add_of_the_same_name():
    things().remove(things()['First'])
    add_object(bpy.data.meshes['Shared'], 'First')


def hide():
    things()['Quad 0'].hide_set(True)


def disable():
    things()['First'].hide_viewport = True


def exclude():
    layer_collection('Extra').exclude = True


def rename():
    things()['First'].name = 'Renamed'
    bpy.data.meshes['Shared'].name = 'Shared by three'


def swap_names():
    things()['First'].name, things()['Text'].name = 'Text.', 'First'
    things()['Text.'].name = 'Text'


def swap_meshes():
    a, b = things()['First'], things()['Quad 2']
    a.data, b.data = b.data, a.data


def make_single_user():
    things()['Quad 1'].data = things()['Quad 1'].data.copy()


def edit_mesh():
    bpy.data.meshes['Shared'].vertices[0].co.z = -2
    bpy.data.meshes['Shared'].update()


def edit_topology():
    mesh = things()['First'].data
    edit = bmesh.new()
    edit.from_mesh(mesh)
    edit.faces.ensure_lookup_table()
    bmesh.ops.delete(edit, geom=[edit.faces[0]], context='FACES')
    edit.to_mesh(mesh)
    edit.free()


def delete_all_faces():
    bpy.data.meshes['Shared'].clear_geometry()


def break_a_vertex():
    things()['First'].data.vertices[0].co.x = float('nan')
    things()['First'].data.update()


def smooth():
    mesh = things()['First'].data
    mesh.polygons.foreach_set('use_smooth', [True] * len(mesh.polygons))
    mesh.update()


def enter_edit_mode():
    bpy.context.view_layer.objects.active = things()['First']
    bpy.ops.object.mode_set(mode='EDIT')


def edit_in_edit_mode():
    enter_edit_mode()
    mesh = things()['First'].data
    edit = bmesh.from_edit_mesh(mesh)
    edit.verts.ensure_lookup_table()
    edit.verts[0].co.x = -4
    bmesh.update_edit_mesh(mesh)


def leave_edit_mode():
    edit_in_edit_mode()
    bpy.context.view_layer.update()
    bpy.ops.object.mode_set(mode='OBJECT')


def add_modifier():
    things()['First'].modifiers.new('Subdivision', 'SUBSURF')


def modifier_on_one_user():
    things()['Quad 0'].modifiers.new('Array', 'ARRAY')


def change_modifier():
    add_modifier()
    bpy.context.view_layer.update()
    things()['First'].modifiers[0].levels = 2


def remove_modifier():
    add_modifier()
    bpy.context.view_layer.update()
    things()['First'].modifiers.clear()


def shape_key():
    thing = things()['First']
    thing.shape_key_add(name='Basis')
    thing.shape_key_add(name='Key').data[0].co.z = 3
    bpy.context.view_layer.update()
    thing.data.shape_keys.key_blocks['Key'].value = 0.5


def uv_map():
    mesh = things()['First'].data
    mesh.uv_layers[0].data[3].uv = (0.25, 0.125)
    mesh.uv_layers.new(name='Second').active_render = True
    mesh.update()


def color_attribute():
    mesh = things()['First'].data
    mesh.color_attributes.new('Color', 'FLOAT_COLOR', 'POINT').data[0].color = (1, 0, 0, 1)
    mesh.update()


def attribute_that_a_material_reads():
    mesh = things()['First'].data
    mesh.attributes.new('height', 'FLOAT', 'POINT').data[1].value = 2
    mesh.update()
    bpy.context.view_layer.update()
    things()['First'].material_slots[0].material = material_reading('height')


def attribute_that_a_material_reads_no_longer():
    attribute_that_a_material_reads()
    bpy.context.view_layer.update()
    things()['First'].material_slots[0].material = bpy.data.materials['Green']


def attribute_that_an_edited_material_reads():
    mesh = things()['First'].data
    mesh.attributes.new('height', 'FLOAT', 'POINT').data[1].value = 2
    material = things()['First'].material_slots[0].material = material_reading('other')
    bpy.context.view_layer.update()
    next(n for n in material.node_tree.nodes if n.type == 'ATTRIBUTE').attribute_name = 'height'


def attribute_that_another_users_material_reads():
    bpy.data.meshes['Shared'].attributes.new('height', 'FLOAT', 'POINT')
    slot = things()['Quad 2'].material_slots[0]
    slot.link = 'OBJECT'
    slot.material = material_reading('height')


def material_value():
    node = next(n for n in bpy.data.materials['Red'].node_tree.nodes if n.type == 'BSDF_PRINCIPLED')
    node.inputs['Roughness'].default_value = 0.1


def material_of_faces():
    mesh = things()['First'].data
    mesh.polygons[2].material_index = 1
    mesh.update()


def object_slot():
    slot = things()['Quad 1'].material_slots[0]
    slot.link = 'OBJECT'
    slot.material = bpy.data.materials['Green']


def remove_material_slot():
    things()['First'].data.materials.pop(index=1)


def instance_move():
    things()['Instancer'].location.z = 3


def instanced_object():
    things()['Inside'].data.vertices[0].co.x = 7
    things()['Inside'].data.update()


def another_instancer():
    add_object(None, 'Second', instance_type='COLLECTION', location=(0, 4, 0),
               instance_collection=bpy.data.collections['Inner'])


def particles():
    modifier = things()['First'].modifiers.new('Particles', 'PARTICLE_SYSTEM')
    settings = modifier.particle_system.settings
    settings.type, settings.count, settings.render_type = 'HAIR', 20, 'OBJECT'
    settings.instance_object = things()['Quad 0']


def fewer_particles():
    particles()
    bpy.context.view_layer.update()
    bpy.data.particles[0].count = 5


def text_body():
    bpy.data.curves['Text'].body = 'xyz'


def hide_from_camera():
    things()['First'].visible_camera = False


def hide_from_all_rays():
    for name in ('camera', 'diffuse', 'glossy', 'transmission', 'volume_scatter', 'shadow'):
        setattr(things()['First'], f'visible_{name}', False)


def lamp():
    bpy.data.lights['Lamp'].energy = 77


def world():
    tree = bpy.data.worlds['World'].node_tree
    next(n for n in tree.nodes if n.type == 'BACKGROUND').inputs['Strength'].default_value = 3


def frame():
    thing = things()['First']
    thing.keyframe_insert('location', frame=1)
    thing.location.z = 9
    thing.keyframe_insert('location', frame=3)
    bpy.context.view_layer.update()
    bpy.context.scene.frame_set(2)


EDITS = [move, mirror, add, add_user_of_a_mesh, delete, delete_and_add_of_the_same_name, hide, disable,
         exclude, rename, swap_names, swap_meshes, make_single_user, edit_mesh, edit_topology,
         delete_all_faces, break_a_vertex, smooth, enter_edit_mode, edit_in_edit_mode, leave_edit_mode,
         add_modifier, modifier_on_one_user, change_modifier, remove_modifier, shape_key, uv_map,
         color_attribute, attribute_that_a_material_reads, attribute_that_a_material_reads_no_longer,
         attribute_that_an_edited_material_reads, attribute_that_another_users_material_reads,
         material_value, material_of_faces, object_slot, remove_material_slot, instance_move,
         instanced_object, another_instancer, particles, fewer_particles, text_body, hide_from_camera,
         hide_from_all_rays, lamp, world, frame]


# Nothing of these shows in the end; all others have to arrive.
UNSEEN = (rename, swap_names, enter_edit_mode, remove_modifier)


@pytest.mark.parametrize('edit', EDITS, ids=lambda edit: edit.__name__)
def test_edit(stage, edit):
    with Follower() as follower:
        before = follower.state.contents()
        edit()
        follower.check()
        assert (follower.state.contents() == before) == (edit in UNSEEN)


# Undo replaces the data-blocks and is the same whatever was edited; these differ in what comes back.
UNDONE = [move, add, delete, hide, rename, swap_meshes, edit_mesh, edit_topology, leave_edit_mode,
          add_modifier, attribute_that_a_material_reads, material_value, object_slot, particles, lamp]


@pytest.mark.parametrize('edit', UNDONE, ids=lambda edit: edit.__name__)
def test_undo_and_redo(stage, edit):
    with Follower() as follower:
        bpy.ops.ed.undo_push(message='before')
        before = follower.state.contents()
        edit()
        bpy.context.view_layer.update()
        after = follower.state.contents()
        bpy.ops.ed.undo_push(message='edit')
        bpy.ops.ed.undo()
        follower.check()
        assert follower.state.contents() == before
        bpy.ops.ed.redo()
        follower.check()
        assert follower.state.contents() == after


def test_undo_extracts_what_changed(stage):
    """Keys outlive undo, so that data-blocks which come back the same are not sent again."""
    with Follower() as follower:
        bpy.ops.ed.undo_push(message='before')
        move()
        bpy.context.view_layer.update()
        bpy.ops.ed.undo_push(message='edit')
        sent = []
        follower.state.set_mesh = lambda mesh_id, *arguments: sent.append(mesh_id)
        bpy.ops.ed.undo()
        bpy.context.view_layer.update()
        assert sent == []


def test_undo_in_edit_mode(stage):
    with Follower() as follower:
        enter_edit_mode()
        follower.check()
        bpy.ops.mesh.select_all(action='SELECT')
        bpy.ops.ed.undo_push(message='before')
        bpy.ops.transform.translate(value=(1, 2, 3))
        bpy.ops.ed.undo_push(message='edit')
        follower.check()
        bpy.ops.ed.undo()
        follower.check()
        bpy.ops.object.mode_set(mode='OBJECT')
        follower.check()


def test_many_edits_in_a_row(stage):
    """Edits pile up: nothing depends on what a single one left behind."""
    rng = np.random.default_rng(0)
    safe = [move, add, add_user_of_a_mesh, edit_mesh, smooth, material_value, object_slot, lamp, world,
            add_modifier, another_instancer, hide_from_camera, color_attribute, instanced_object]
    with Follower() as follower:
        for index in rng.integers(0, len(safe), 25):
            safe[index]()
            follower.check()
