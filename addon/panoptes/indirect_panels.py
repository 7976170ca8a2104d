# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of indirect light and specular rays: in the Render tab for all of Real-time, in the Object tab for one."""

import bpy

from . import requests
from .engine_panel import EnginePanel, GEOMETRY


class _RealtimePanel(EnginePanel):
    """Common part of panels that count for Real-time only."""

    @classmethod
    def poll(cls, context):
        """Show the panel where Real-time is used."""
        return super().poll(context) and requests.method(context.scene.panoptes) == 'realtime'


class PANOPTES_PT_indirect_light(_RealtimePanel, bpy.types.Panel):
    """How much light surfaces reflect on each other, and how finely it is known."""

    bl_label = 'Indirect Light'

    def draw_header(self, context):
        """Draw the switch of all of it."""
        self.layout.prop(context.scene.panoptes.radiance_cache, 'enabled', text='')

    def draw(self, context):
        """Draw the panel."""
        scene = context.scene.panoptes
        settings = scene.radiance_cache
        column = self._column()
        column.active = settings.enabled
        column.prop(settings, 'bounces')
        if scene.bounces < settings.bounces:
            column.prop(scene, 'bounces', text='Bounces of All Methods')
        column.prop(settings, 'resolution')
        column.prop(settings, 'luminance')
        column.prop(settings, 'chrominance')
        column.prop(settings, 'region_collection')


class _IndirectSubPanel(_RealtimePanel):
    """Common part of the panels for experts."""

    bl_parent_id = 'PANOPTES_PT_indirect_light'
    bl_options = {'DEFAULT_CLOSED'}


class PANOPTES_PT_indirect_cells(_IndirectSubPanel, bpy.types.Panel):
    """Where cells are, and what they know."""

    bl_label = 'Cells'

    def draw(self, context):
        """Draw the panel."""
        settings = context.scene.panoptes.radiance_cache
        column = self._column()
        column.active = settings.enabled
        for name in ('encoding', 'cascades', 'voxels', 'voxel_fill', 'occupancy'):
            column.prop(settings, name)
        if settings.occupancy in {'AUTO', 'DEPTH', 'TIERS'}:
            column.prop(settings, 'depth_stride')
        if settings.occupancy != 'ALL':
            column.prop(settings, 'dilate')


class PANOPTES_PT_indirect_gathering(_IndirectSubPanel, bpy.types.Panel):
    """How light gets into cells."""

    bl_label = 'Gathering'

    def draw(self, context):
        """Draw the panel."""
        settings = context.scene.panoptes.radiance_cache
        column = self._column()
        column.active = settings.enabled
        column.prop(settings, 'first_bounce')
        if settings.first_bounce == 'RSM':
            for name in ('rsm_samples', 'rsm_resolution', 'rsm_spread', 'rsm_mixed'):
                column.prop(settings, name)
        column.prop(settings, 'directions')
        column.prop(settings, 'march_steps')
        column.prop(settings, 'blend')
        column.prop(settings, 'rebuild_every')


class PANOPTES_PT_specular_rays(_RealtimePanel, bpy.types.Panel):
    """What mirrors and glass show."""

    bl_label = 'Specular Rays'
    bl_options = {'DEFAULT_CLOSED'}

    def draw(self, context):
        """Draw the panel."""
        settings = context.scene.panoptes.specular_rays
        column = self._column()
        column.prop(settings, 'mode', text='Rays')
        if settings.mode == 'AUTO':
            column.prop(settings, 'roughness', text='Up to Roughness')


class PANOPTES_PT_object_indirect_light(EnginePanel, bpy.types.Panel):
    """Indirect light on an object, on all that it instances, or in it as a region."""

    bl_label = 'Indirect Light'
    bl_context = 'object'
    bl_options = {'DEFAULT_CLOSED'}

    @classmethod
    def poll(cls, context):
        """Show the panel for what has a surface, and for empties, which may be regions or instance collections."""
        thing = context.object
        return super().poll(context) and thing is not None and (thing.type in GEOMETRY or thing.type == 'EMPTY')

    def draw(self, context):
        """Draw the panel."""
        column = self._column()
        column.prop(context.object.panoptes, 'indirect_luminance')
        column.prop(context.object.panoptes, 'indirect_chrominance')


CLASSES = (PANOPTES_PT_indirect_light, PANOPTES_PT_indirect_cells, PANOPTES_PT_indirect_gathering,
           PANOPTES_PT_specular_rays)
OBJECT_CLASSES = (PANOPTES_PT_object_indirect_light,)
