# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of ambient occlusion in the Render tab."""

import bpy

from . import requests
from .engine_panel import EnginePanel


def _is_realtime(context):
    return requests.method(context.scene.panoptes) == 'realtime'


class PANOPTES_PT_occlusion(EnginePanel, bpy.types.Panel):
    """What darkens the world's light in Real-time; for paths only how far their AO pass looks."""

    bl_label = 'Ambient Occlusion'

    @classmethod
    def poll(cls, context):
        """Show the panel where occlusion is looked for."""
        return super().poll(context) and (_is_realtime(context) or context.view_layer.use_pass_ambient_occlusion)

    def draw(self, context):
        """Draw the panel."""
        settings = context.scene.panoptes.ambient_occlusion
        column = self._column()
        column.prop(settings, 'distance')
        if settings.distance == 0.0 and context.scene.world is not None:
            column.prop(context.scene.world.light_settings, 'distance', text="World's Distance")
        if not _is_realtime(context):
            return
        column.prop(settings, 'strength')
        column.prop(settings, 'estimator')
        # Horizons have a fixed number of samples.
        if settings.estimator != 'HBAO':
            column.prop(settings, 'samples')
            column.prop(settings, 'importance_sampling')
            if settings.importance_sampling:
                column.prop(settings, 'initial_samples')
        column.prop(settings, 'filter')
        column.prop(settings, 'deep_shadows')


class PANOPTES_PT_occlusion_views(EnginePanel, bpy.types.Panel):
    """From where occlusion looks at the scene, besides the camera."""

    bl_label = 'Views'
    bl_parent_id = 'PANOPTES_PT_occlusion'
    bl_options = {'DEFAULT_CLOSED'}

    @classmethod
    def poll(cls, context):
        """Show the panel where views are used."""
        return super().poll(context) and _is_realtime(context)

    def draw(self, context):
        """Draw the panel."""
        settings = context.scene.panoptes.ambient_occlusion
        column = self._column()
        column.prop(settings, 'secondary_views')
        column.prop(settings, 'phantom_cameras')
        chosen = settings.phantom_cameras
        has_cameras = chosen is not None and any(thing.type == 'CAMERA' for thing in chosen.all_objects)
        if not has_cameras:
            column.prop(settings, 'phantoms')
        if has_cameras or settings.phantoms != 'OFF':
            column.prop(settings, 'phantom_resolution')


CLASSES = (PANOPTES_PT_occlusion, PANOPTES_PT_occlusion_views)
