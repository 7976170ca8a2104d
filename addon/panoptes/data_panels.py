# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of objects, lamps and worlds, where Blender's own offer more than a render follows."""

import bpy
from bpy_extras.node_utils import find_node_input

from . import compat
from .engine_panel import EnginePanel, GEOMETRY


class PANOPTES_PT_visibility(EnginePanel, bpy.types.Panel):
    """Where an object is shown."""

    bl_label = 'Visibility'
    bl_context = 'object'
    bl_options = {'DEFAULT_CLOSED'}

    @classmethod
    def poll(cls, context):
        """Show the panel for all objects."""
        return super().poll(context) and context.object is not None

    def draw(self, context):
        """Draw the panel."""
        thing = context.object
        column = self._column()
        column.prop(thing, 'hide_select', text='Selectable', invert_checkbox=True)
        shown = column.column(heading='Show In')
        shown.prop(thing, 'hide_viewport', text='Viewports', toggle=False, invert_checkbox=True)
        shown.prop(thing, 'hide_render', text='Renders', toggle=False, invert_checkbox=True)


class PANOPTES_PT_ray_visibility(EnginePanel, bpy.types.Panel):
    """Which kinds of rays meet an object; Blender draws these switches in Cycles' panel only."""

    bl_label = 'Ray Visibility'
    bl_parent_id = 'PANOPTES_PT_visibility'
    bl_context = 'object'

    @classmethod
    def poll(cls, context):
        """Show the panel for objects with a surface."""
        return super().poll(context) and context.object.type in GEOMETRY

    def draw(self, context):
        """Draw the panel."""
        column = self._column()
        for kind in ('camera', 'diffuse', 'glossy', 'transmission', 'volume_scatter', 'shadow'):
            column.prop(context.object, f'visible_{kind}', text=kind.replace('_', ' ').title())


class PANOPTES_PT_light(EnginePanel, bpy.types.Panel):
    """Values of a lamp."""

    bl_label = 'Light'
    bl_context = 'data'

    @classmethod
    def poll(cls, context):
        """Show the panel for lamps."""
        return super().poll(context) and context.light is not None

    def draw(self, context):
        """Draw the panel."""
        light = context.light
        self.layout.row().prop(light, 'type', expand=True)
        column = self._column()
        for name in compat.light_color_properties(light):
            column.prop(light, name)
        column.prop(light, 'energy', text='Strength' if light.type == 'SUN' else 'Power')
        if light.type in ('POINT', 'SPOT'):
            column.prop(light, 'shadow_soft_size', text='Radius')
        if light.type == 'SUN':
            column.prop(light, 'angle')
        if light.type == 'SPOT':
            column.prop(light, 'spot_size', text='Cone Angle')
            column.prop(light, 'spot_blend', text='Blend', slider=True)
            column.prop(light, 'show_cone')
        if light.type == 'AREA':
            column.prop(light, 'shape')
            two = light.shape in ('RECTANGLE', 'ELLIPSE')
            column.prop(light, 'size', text='Size X' if two else 'Size')
            if two:
                column.prop(light, 'size_y', text='Y')
            column.prop(light, 'spread')
        for owner, name, label in compat.light_shadow_switches(light):
            column.prop(owner, name, text=label)


class PANOPTES_PT_light_nodes(EnginePanel, bpy.types.Panel):
    """The node tree of a lamp."""

    bl_label = 'Nodes'
    bl_context = 'data'
    bl_options = {'DEFAULT_CLOSED'}

    @classmethod
    def poll(cls, context):
        """Show the panel for lamps."""
        return super().poll(context) and context.light is not None

    def draw(self, context):
        """Draw the panel."""
        light = context.light
        if not compat.uses_nodes(light):
            self.layout.prop(light, 'use_nodes', icon='NODETREE')
            return
        self.layout.use_property_split = True
        output = light.node_tree.get_output_node('CYCLES')
        socket = find_node_input(output, 'Surface') if output else None
        if socket is None:
            self.layout.label(text='No output node')
        else:
            self.layout.template_node_view(light.node_tree, output, socket)


class PANOPTES_PT_world_preview(EnginePanel, bpy.types.Panel):
    """A small render of the world; Blender has a panel for it in Cycles only."""

    bl_label = 'Preview'
    bl_context = 'world'
    bl_options = {'DEFAULT_CLOSED'}

    @classmethod
    def poll(cls, context):
        """Show the panel where there is a world."""
        return super().poll(context) and context.world is not None

    def draw(self, context):
        """Draw the panel."""
        self.layout.template_preview(context.world)


CLASSES = (PANOPTES_PT_visibility, PANOPTES_PT_ray_visibility, PANOPTES_PT_light,
           PANOPTES_PT_light_nodes, PANOPTES_PT_world_preview)
