# SPDX-License-Identifier: GPL-3.0-or-later
"""Edits as artists make them, of the room in edit_scene.py and of the 3D View that shows it.

Each is a function of a `random.Random`, which says how much is changed. After undo nothing that Python holds of Blender
is valid, so everything is found by its name.
"""

import contextlib

import bmesh
import bpy
from mathutils import Quaternion

from building import add_object, principled
from edit_scene import BENDING, BLOWING, box_mesh, paint
from window_steps import area, areas, background

_counter = iter(range(1, 1 << 30))


def thing(name):
    """Return an object by its name."""
    return bpy.data.objects[name]


def view(index=0):
    """Return the 3D View's space."""
    return areas('VIEW_3D')[index].spaces[0]


@contextlib.contextmanager
def in_view():
    """Operators work in the first 3D View."""
    place = area('VIEW_3D')
    region = next(r for r in place.regions if r.type == 'WINDOW')
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0], area=place, region=region):
        yield


# --- the view -------------------------------------------------------------------------------------------


def orbit(random):
    turn = Quaternion((0.0, 0.0, 1.0), random.uniform(0.2, 0.6))
    view().region_3d.view_rotation = turn @ view().region_3d.view_rotation


def zoom(random):
    view().region_3d.view_distance = random.uniform(6.0, 10.0)


def split_view(random):
    """Two 3D Views, the second of which looks from elsewhere."""
    if len(areas('VIEW_3D')) > 1:
        return join_views(random)
    with in_view():
        bpy.ops.screen.area_split(direction='VERTICAL', factor=0.5)
    space = view(1)
    space.shading.type = 'RENDERED'
    space.region_3d.view_perspective = 'PERSP'
    space.region_3d.view_distance = 6.0
    space.region_3d.view_rotation = Quaternion((0.8, 0.5, 0.1, 0.2)).normalized()


def join_views(random):
    """Only the first 3D View is left, as large as the window."""
    for other in areas('VIEW_3D')[1:]:
        with bpy.context.temp_override(window=bpy.context.window_manager.windows[0], area=other):
            bpy.ops.screen.area_close()


def camera_border(random):
    render = bpy.context.scene.render
    render.use_border = True
    render.border_min_x, render.border_max_x = 0.1, random.uniform(0.5, 0.9)
    render.border_min_y, render.border_max_y = 0.2, random.uniform(0.5, 0.9)
    view().region_3d.view_perspective = 'CAMERA'


def no_border(random):
    bpy.context.scene.render.use_border = False
    view().region_3d.view_perspective = 'PERSP'


def local_view(random):
    """In and out again."""
    if view().local_view is None:
        for one in bpy.context.view_layer.objects:
            one.select_set(one.name in ('Ball', 'Box', 'Floor', 'Lamp'))
        bpy.context.view_layer.objects.active = thing('Ball')
    with in_view():
        bpy.ops.view3d.localview(frame_selected=False)


def solid(random):
    view().shading.type = 'SOLID'


def rendered(random):
    view().shading.type = 'RENDERED'


# --- objects and meshes ---------------------------------------------------------------------------------


def move_object(random):
    thing('Box').location.x = random.uniform(-2.0, -1.0)
    thing('Box').rotation_euler.z = random.uniform(0.0, 1.0)


def edit_vertices(random):
    """A few are pulled out, and edit mode is still on; what is hidden cannot be edited."""
    if not thing('Ball').visible_get():
        return
    bpy.context.view_layer.objects.active = thing('Ball')
    with in_view():
        bpy.ops.object.mode_set(mode='EDIT')
    mesh = thing('Ball').data
    form = bmesh.from_edit_mesh(mesh)
    form.verts.ensure_lookup_table()
    for index in range(5):
        form.verts[index].co *= random.uniform(0.8, 1.5)
    bmesh.update_edit_mesh(mesh)


def leave_edit_mode(random):
    if bpy.context.mode == 'OBJECT':
        return
    bpy.context.view_layer.objects.active = thing('Ball')
    with in_view():
        bpy.ops.object.mode_set(mode='OBJECT')


def _play(frames):
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = frames
    scene.frame_set(frames[0])
    with in_view():
        bpy.ops.screen.animation_play()


def play_armature(random):
    _play(BENDING)


def play_shape_keys(random):
    _play(BLOWING)


def stop(random):
    """Playback ends at whichever frame it has reached."""
    with in_view():
        bpy.ops.screen.animation_cancel(restore_frame=False)


def pose(random):
    bpy.context.scene.frame_set(random.randint(*BENDING))


def shape(random):
    bpy.context.scene.frame_set(random.randint(*BLOWING))


def add_thing(random):
    name = f'Added {next(_counter)}'
    place = random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(1.3, 1.7)
    add_object(box_mesh(name, 0.5), name, location=place)
    thing(name).data.materials.append(bpy.data.materials['Green'])


def delete_thing(random):
    """The one that was added last, if one was."""
    names = sorted((one.name for one in bpy.data.objects if one.name.startswith('Added')), key=lambda n: int(n.split()[1]))
    if names:
        bpy.data.objects.remove(thing(names[-1]))


def duplicate(random):
    """Another object of the same mesh."""
    place = random.uniform(-2, 2), random.uniform(-2.2, -1.8), random.uniform(1.8, 2.2)
    add_object(bpy.data.meshes['Box'], f'Added {next(_counter)}', location=place)


def hide(random):
    """The eye in the outliner, and back again."""
    thing('Ball').hide_set(not thing('Ball').hide_get())


def disable(random):
    """The screen in the outliner, and back again."""
    thing('Face').hide_viewport = not thing('Face').hide_viewport


def exclude(random):
    """A collection leaves the view layer, and comes back."""
    layer = bpy.context.view_layer.layer_collection.children['Extras']
    layer.exclude = not layer.exclude


def add_modifier(random):
    thing('Box').modifiers.new('Array', 'ARRAY').count = random.randint(2, 3)


def change_modifier(random):
    for modifier in thing('Box').modifiers:
        modifier.relative_offset_displace[0] = random.uniform(1.1, 1.5)


def remove_modifiers(random):
    thing('Box').modifiers.clear()


# --- materials, lamps, the world ------------------------------------------------------------------------


def drag_color(random):
    surface = principled(bpy.data.materials['Paint'])
    surface.inputs['Base Color'].default_value = (*(random.uniform(0.1, 0.9) for _ in range(3)), 1.0)


def drag_roughness(random):
    """Within what takes no traced reflections, for which rays would have to be prepared."""
    principled(bpy.data.materials['Paint']).inputs['Roughness'].default_value = random.uniform(0.6, 0.9)


def relink(random):
    """The image goes to the colour or, by another node, to the emission."""
    tree = bpy.data.materials['Checked'].node_tree
    surface, texture = principled(bpy.data.materials['Checked']), tree.nodes['Texture']
    color = surface.inputs['Base Color']
    if color.is_linked:
        invert = tree.nodes.get('Invert') or tree.nodes.new('ShaderNodeInvert')
        invert.name = 'Invert'
        tree.links.new(texture.outputs['Color'], invert.inputs['Color'])
        tree.links.remove(color.links[0])
        tree.links.new(invert.outputs['Color'], surface.inputs['Subsurface Color'])
    else:
        tree.links.new(texture.outputs['Color'], color)


def reassign(random):
    """The slot gets another material; scripts that write to the mesh's own list tell Blender of no change."""
    other = {'Red': 'Green', 'Green': 'Red'}
    slot = thing('Box').material_slots[0]
    slot.material = bpy.data.materials[other[slot.material.name]]


def new_material(random):
    name = f'New {next(_counter)}'
    thing('Extra 0').material_slots[0].link = 'OBJECT'
    thing('Extra 0').material_slots[0].material = paint(name, (random.random(), 0.5, 0.5))


def lamp_color(random):
    bpy.data.lights['Lamp'].color = (1.0, random.uniform(0.3, 1.0), random.uniform(0.3, 1.0))


def lamp_energy(random):
    bpy.data.lights['Lamp'].energy = random.uniform(100.0, 500.0)


def lamp_type(random):
    kinds = ('POINT', 'SPOT', 'AREA')
    lamp = bpy.data.lights['Lamp']
    lamp.type = kinds[(kinds.index(lamp.type) + 1) % len(kinds)]


def move_lamp(random):
    thing('Lamp').location = (random.uniform(-2, 2), random.uniform(-2, 0), 3.0)


def world_color(random):
    background().inputs['Color'].default_value = (*(random.uniform(0.1, 0.6) for _ in range(3)), 1.0)


def world_nodes(random):
    """The sky's colour comes from its direction, or from a value again."""
    tree, color = bpy.context.scene.world.node_tree, background().inputs['Color']
    if color.is_linked:
        tree.links.remove(color.links[0])
        return
    node = tree.nodes.get('Where') or tree.nodes.new('ShaderNodeTexCoord')
    node.name = 'Where'
    tree.links.new(node.outputs['Generated'], color)


def undo(random):
    with in_view():
        if bpy.ops.ed.undo.poll():
            bpy.ops.ed.undo()


def redo(random):
    with in_view():
        if bpy.ops.ed.redo.poll():
            bpy.ops.ed.redo()
