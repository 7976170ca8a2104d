# SPDX-License-Identifier: GPL-3.0-or-later
"""The edits that a 3D View has to follow, by their names in edits.py, in the order in which they are made."""

ACTIONS = ('orbit', 'zoom', 'move_object', 'edit_vertices', 'leave_edit_mode', 'undo', 'redo', 'play_armature', 'stop',
           'play_shape_keys', 'stop', 'drag_color', 'drag_roughness', 'undo', 'redo', 'relink', 'undo', 'redo', 'reassign',
           'lamp_color', 'lamp_energy', 'lamp_type', 'undo', 'redo', 'move_lamp', 'world_color', 'world_nodes', 'undo',
           'add_thing', 'undo', 'redo', 'duplicate', 'delete_thing', 'undo', 'hide', 'hide', 'disable', 'disable',
           'exclude', 'undo', 'redo', 'exclude', 'new_material', 'add_modifier', 'change_modifier', 'undo', 'redo',
           'remove_modifiers', 'split_view', 'move_object', 'join_views', 'local_view', 'move_object', 'local_view',
           'solid', 'move_object', 'rendered', 'camera_border', 'move_object', 'no_border')
# What reaches lights, materials, geometry, the world and the list of things in one way each.
SOME = ('orbit', 'move_object', 'undo', 'redo', 'drag_color', 'relink', 'lamp_energy', 'lamp_type', 'move_lamp', 'world_color',
        'add_thing', 'delete_thing', 'hide', 'hide', 'exclude')
# Steps of the walk: edits that leave the view able to take any other.
WALKED = ('orbit', 'zoom', 'move_object', 'edit_vertices leave_edit_mode', 'pose', 'shape', 'drag_color', 'drag_roughness',
           'relink', 'reassign', 'lamp_color', 'lamp_energy', 'lamp_type', 'move_lamp', 'world_color', 'world_nodes',
           'add_thing', 'duplicate', 'delete_thing', 'hide', 'disable', 'exclude', 'new_material', 'add_modifier',
           'change_modifier', 'remove_modifiers', 'split_view', 'local_view', 'solid rendered', 'camera_border',
           'no_border', 'undo', 'undo', 'undo', 'redo', 'redo')
# By how much the mean of a block of pixels may differ from a fresh picture's where single pixels depend on the order in
# which lamps and instances are sent: light gathered by the cache, and the noise of paths.
APART = {'cache': 0.02, 'paths': 0.05}
