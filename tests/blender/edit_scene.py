# SPDX-License-Identifier: GPL-3.0-or-later
"""A room with one of everything that artists edit, for windows in which edits are tried.

Its floor and its image are large beside the rest: whoever sends them again without need is found out.
Nothing touches the floor: where surfaces coincide, the one that is drawn first shows, and the order of drawing is not that
of a fresh engine once things have come and gone. Frames 1 to 20 bend the worm by its armature, frames 21 to 40 blow up
the face by its shape key.
"""

import math

import bpy
import numpy as np
from mathutils import Vector

from building import add_object, grid, principled

FLOOR_SIDE = 48
IMAGE_SIDE = 128
BENDING, BLOWING = (1, 20), (21, 40)


def build():
    """Make the room the scene's only content; returns nothing, things are found by their names."""
    scene = bpy.context.scene
    for thing in list(scene.objects):
        bpy.data.objects.remove(thing)
    scene.frame_start, scene.frame_end = BENDING[0], BLOWING[1]
    _walls()
    _things()
    _worm()
    _face()
    _lights(scene)
    camera = add_object(bpy.data.cameras.new('Camera'), 'Camera', location=(3.0, -5.0, 2.5))
    camera.rotation_euler = (math.radians(70.0), 0.0, math.radians(30.0))
    scene.camera = camera
    scene.frame_set(1)


def paint(name, color, roughness=0.5):
    """Return a material of one colour."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    surface = principled(made)
    surface.inputs['Base Color'].default_value = (*color, 1.0)
    surface.inputs['Roughness'].default_value = roughness
    return made


def ball_mesh(name, rings=10, radius=0.6):
    """Return a sphere of 2 * rings segments."""
    import bmesh

    mesh, form = bpy.data.meshes.new(name), bmesh.new()
    bmesh.ops.create_uvsphere(form, u_segments=2 * rings, v_segments=rings, radius=radius)
    form.to_mesh(mesh)
    form.free()
    return mesh


def box_mesh(name, size=1.0):
    """Return a cube."""
    import bmesh

    mesh, form = bpy.data.meshes.new(name), bmesh.new()
    bmesh.ops.create_cube(form, size=size, calc_uvs=True)
    form.to_mesh(mesh)
    form.free()
    return mesh


def _walls():
    checked = paint('Checked', (0.8, 0.8, 0.8))
    image = bpy.data.images.new('Checks', IMAGE_SIDE, IMAGE_SIDE)
    y, x = np.mgrid[:IMAGE_SIDE, :IMAGE_SIDE] // 16
    pixels = np.ones((IMAGE_SIDE, IMAGE_SIDE, 4), np.float32)
    pixels[..., 0] = 0.2 + 0.6 * ((x + y) % 2)
    image.pixels.foreach_set(pixels.ravel())
    image.pack()
    texture = checked.node_tree.nodes.new('ShaderNodeTexImage')
    texture.name, texture.image = 'Texture', image
    checked.node_tree.links.new(texture.outputs['Color'], principled(checked).inputs['Base Color'])
    floor = add_object(grid('Floor', FLOOR_SIDE, 8.0), 'Floor')
    floor.data.materials.append(checked)
    back = add_object(grid('Back', 4, 8.0), 'Back', location=(0.0, 4.0, 2.0))
    back.rotation_euler = (math.radians(90.0), 0.0, 0.0)
    back.data.materials.append(paint('Wall', (0.7, 0.6, 0.5)))


def _things():
    box = add_object(box_mesh('Box'), 'Box', location=(-1.5, 0.0, 0.55))
    box.data.materials.append(paint('Red', (0.8, 0.1, 0.1)))
    ball = add_object(ball_mesh('Ball'), 'Ball', location=(0.0, 1.0, 0.65))
    ball.data.materials.append(paint('Paint', (0.1, 0.3, 0.8), 0.7))
    extras = bpy.data.collections.new('Extras')
    bpy.context.scene.collection.children.link(extras)
    for number in range(2):
        extra = bpy.data.objects.new(f'Extra {number}', box.data)
        extra.location, extra.scale = (1.0 + number, -1.5, 0.3), (0.5, 0.5, 0.5)
        extras.objects.link(extra)


def _worm():
    """A tube of two bones, the upper of which bends."""
    mesh = ball_mesh('Worm', 8, 0.3)
    for vertex in mesh.vertices:
        vertex.co.z = (vertex.co.z + 0.3) * 3.0
    worm = add_object(mesh, 'Worm', location=(1.5, 1.0, 0.05))
    mesh.materials.append(paint('Green', (0.1, 0.6, 0.2)))
    rig = add_object(bpy.data.armatures.new('Rig'), 'Rig', location=worm.location)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode='EDIT')
    lower, upper = (rig.data.edit_bones.new(name) for name in ('Lower', 'Upper'))
    lower.head, lower.tail = Vector((0.0, 0.0, 0.0)), Vector((0.0, 0.0, 0.9))
    upper.head, upper.tail, upper.parent = lower.tail, Vector((0.0, 0.0, 1.8)), lower
    bpy.ops.object.mode_set(mode='OBJECT')
    groups = {name: worm.vertex_groups.new(name=name) for name in ('Lower', 'Upper')}
    for vertex in mesh.vertices:
        share = min(max(vertex.co.z - 0.4, 0.0), 1.0)
        groups['Upper'].add([vertex.index], share, 'REPLACE')
        groups['Lower'].add([vertex.index], 1.0 - share, 'REPLACE')
    worm.modifiers.new('Rig', 'ARMATURE').object = rig
    bone = rig.pose.bones['Upper']
    bone.rotation_mode = 'XYZ'
    for frame, angle in zip(BENDING, (0.0, 1.2)):
        bone.rotation_euler.x = angle
        bone.keyframe_insert('rotation_euler', frame=frame)


def _face():
    face = add_object(ball_mesh('Face', 8, 0.4), 'Face', location=(-0.3, -1.2, 0.45))
    face.data.materials.append(bpy.data.materials['Paint'])
    face.shape_key_add(name='Basis')
    blown = face.shape_key_add(name='Blown')
    for point in blown.data:
        point.co.x *= 2.0
    for frame, value in zip(BLOWING, (0.0, 1.0)):
        blown.value = value
        blown.keyframe_insert('value', frame=frame)


def _lights(scene):
    lamp = add_object(bpy.data.lights.new('Lamp', 'POINT'), 'Lamp', location=(1.0, -2.0, 3.5))
    lamp.data.energy, lamp.data.shadow_soft_size = 300.0, 0.2
    sun = add_object(bpy.data.lights.new('Sun', 'SUN'), 'Sun')
    sun.rotation_euler, sun.data.energy = (0.6, 0.4, 0.0), 1.0
    scene.world = bpy.data.worlds.new('World')
    scene.world.use_nodes = True
    shine = next(n for n in scene.world.node_tree.nodes if n.type == 'BACKGROUND')
    shine.inputs['Color'].default_value = (0.3, 0.4, 0.5, 1.0)
