# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of the properties editor, and which of Blender's own panels Panoptes honours."""

import json

import bpy

from . import passes

ENGINE = 'PANOPTES'

# Blender's panels whose settings a render follows, in the versions that have them.
_HONOURED = {
    # Output
    'RENDER_PT_format', 'RENDER_PT_frame_range', 'RENDER_PT_output', 'RENDER_PT_output_views',
    'RENDER_PT_output_color_management', 'RENDER_PT_output_pixel_density', 'RENDER_PT_encoding',
    'RENDER_PT_encoding_video', 'RENDER_PT_encoding_audio', 'RENDER_PT_time_stretching',
    'RENDER_PT_post_processing', 'RENDER_PT_stamp', 'RENDER_PT_stamp_note', 'RENDER_PT_stamp_burn',
    # Render
    'RENDER_PT_simplify', 'RENDER_PT_simplify_viewport', 'RENDER_PT_simplify_render',
    'RENDER_PT_color_management', 'RENDER_PT_color_management_curves',
    'RENDER_PT_color_management_advanced', 'RENDER_PT_color_management_white_balance',
    'RENDER_PT_color_management_working_space',
    # View layer
    'VIEWLAYER_PT_layer', 'VIEWLAYER_PT_context_layer',
    # World
    'WORLD_PT_context_world', 'EEVEE_WORLD_PT_surface', 'WORLD_PT_custom_props',
    # Camera
    'DATA_PT_context_camera', 'DATA_PT_lens', 'DATA_PT_camera', 'DATA_PT_camera_display',
    'DATA_PT_camera_display_composition_guides', 'DATA_PT_camera_safe_areas',
    'DATA_PT_camera_safe_areas_center_cut', 'DATA_PT_camera_background_image', 'CAMERA_PT_presets',
    'SAFE_AREAS_PT_presets', 'DATA_PT_custom_props_camera',
    # Light: its values are in a panel of our own below
    'DATA_PT_context_light', 'DATA_PT_custom_props_light',
    # Material
    'EEVEE_MATERIAL_PT_context_material', 'EEVEE_MATERIAL_PT_surface',
    'EEVEE_MATERIAL_PT_viewport_settings', 'MATERIAL_PT_custom_props', 'NODE_PT_texture_mapping',
    # Geometry
    'DATA_PT_context_mesh', 'DATA_PT_normals', 'DATA_PT_uv_texture', 'DATA_PT_vertex_colors',
    'DATA_PT_vertex_groups', 'DATA_PT_shape_keys', 'DATA_PT_mesh_attributes', 'DATA_PT_remesh',
    'DATA_PT_texture_space', 'DATA_PT_curve_texture_space', 'DATA_PT_mball_texture_space',
    'DATA_PT_customdata', 'DATA_PT_custom_props_mesh', 'OBJECT_PT_visibility',
    'OBJECT_PT_custom_props',
    # Particles that are instanced objects
    'PARTICLE_PT_context_particles', 'PARTICLE_PT_emission', 'PARTICLE_PT_emission_source',
    'PARTICLE_PT_render', 'PARTICLE_PT_render_object', 'PARTICLE_PT_render_collection',
    'PARTICLE_PT_render_collection_use_count', 'PARTICLE_PT_render_extra', 'PARTICLE_PT_velocity',
    'PARTICLE_PT_rotation', 'PARTICLE_PT_physics', 'PARTICLE_PT_children',
}


def _honoured_panels():
    for name in _HONOURED:
        panel = getattr(bpy.types, name, None)
        engines = getattr(panel, 'COMPAT_ENGINES', None)
        if engines is not None:
            yield engines


class _RenderPanel:
    """Common part of panels in the Render tab."""

    bl_space_type = 'PROPERTIES'
    bl_region_type = 'WINDOW'
    bl_context = 'render'
    COMPAT_ENGINES = {ENGINE}

    @classmethod
    def poll(cls, context):
        """Show the panel for Panoptes only."""
        return context.engine in cls.COMPAT_ENGINES

    def _column(self):
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        return self.layout.column()


class PANOPTES_PT_sampling(_RenderPanel, bpy.types.Panel):
    """Method and samples."""

    bl_label = 'Sampling'

    def draw(self, context):
        """Draw the panel."""
        settings = context.scene.panoptes
        column = self._column()
        column.prop(settings, 'samples', text='Render Samples')
        column.prop(settings, 'viewport_samples')


class PANOPTES_PT_sampling_limits(_RenderPanel, bpy.types.Panel):
    """When to stop before all samples are done, and what they start from."""

    bl_label = 'Limits and Seed'
    bl_parent_id = 'PANOPTES_PT_sampling'
    bl_options = {'DEFAULT_CLOSED'}

    def draw(self, context):
        """Draw the panel."""
        settings = context.scene.panoptes
        column = self._column()
        column.prop(settings, 'time_budget')
        column.prop(settings, 'noise_threshold')
        column.prop(settings, 'seed')
        column.prop(settings, 'first_sample')
        column.prop(settings, 'force_all_effects')


class PANOPTES_PT_shadows(_RenderPanel, bpy.types.Panel):
    """Shadow maps of the Real-time method."""

    bl_label = 'Shadows'

    def draw(self, context):
        """Draw the panel."""
        column = self._column()
        column.prop(context.scene.panoptes.realtime, 'shadow_resolution')
        column.prop(context.scene.panoptes.realtime, 'soft_shadows')


class PANOPTES_PT_film(_RenderPanel, bpy.types.Panel):
    """Pixel filter and background."""

    bl_label = 'Film'
    bl_options = {'DEFAULT_CLOSED'}

    def draw(self, context):
        """Draw the panel."""
        column = self._column()
        column.prop(context.scene.render, 'filter_size')
        column.prop(context.scene.render, 'film_transparent', text='Transparent')


def _milliseconds(number):
    return f'{number / 1e3:.2f} s' if number >= 1000 else f'{number:.1f} ms'


class PANOPTES_PT_statistics(_RenderPanel, bpy.types.Panel):
    """What the last final render did: each effect with its time, or why it did not run."""

    bl_label = 'Last Render'
    bl_options = {'DEFAULT_CLOSED'}

    def draw(self, context):
        """Draw the panel."""
        column = self.layout.column(align=True)
        try:
            stats = json.loads(context.scene.panoptes.last_stats or 'null')
        except ValueError:
            stats = None
        if not stats:
            column.label(text='No render yet')
            return
        total, sync = (_milliseconds(stats.get(k, 0.0)) for k in ('total_ms', 'sync_ms'))
        column.label(text=f'{stats.get("device", "")}')
        column.label(text=f'{stats.get("samples", 0)} samples in {total} (scene read in {sync})')
        column.label(text=f'{stats.get("memory_bytes", 0) / 2**20:.0f} MiB')
        column.separator()
        for effect in stats.get('effects', ()):
            if effect.get('runs'):
                text, icon = f'{effect["name"]}: {_milliseconds(effect.get("ms") or 0.0)}', 'CHECKMARK'
            else:
                text, icon = f'{effect["name"]}: {effect.get("reason", "")}', 'BLANK1'
            column.label(text=text, icon=icon)
        for sentence in stats.get('warnings', ()):
            column.label(text=sentence, icon='ERROR')


class PANOPTES_PT_passes(_RenderPanel, bpy.types.Panel):
    """Passes of the view layer that Panoptes can render."""

    bl_label = 'Passes'
    bl_context = 'view_layer'

    def draw(self, context):
        """Draw the panel."""
        column = self._column()
        for entry in passes.PASSES:
            if entry.switch:
                column.prop(context.view_layer, entry.switch)


class PANOPTES_PT_light(_RenderPanel, bpy.types.Panel):
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
        column.prop(light, 'color')
        column.prop(light, 'energy', text='Strength' if light.type == 'SUN' else 'Power')
        if light.type in ('POINT', 'SPOT'):
            column.prop(light, 'shadow_soft_size', text='Radius')
        if light.type == 'SUN':
            column.prop(light, 'angle')
        if light.type == 'SPOT':
            column.prop(light, 'spot_size', text='Cone Angle')
            column.prop(light, 'spot_blend', text='Blend', slider=True)
        if light.type == 'AREA':
            column.prop(light, 'shape')
            two = light.shape in ('RECTANGLE', 'ELLIPSE')
            column.prop(light, 'size', text='Size X' if two else 'Size')
            if two:
                column.prop(light, 'size_y', text='Y')
            column.prop(light, 'spread')
        column.prop(light, 'use_shadow', text='Cast Shadow')


_CLASSES = (PANOPTES_PT_sampling, PANOPTES_PT_sampling_limits, PANOPTES_PT_shadows, PANOPTES_PT_film,
            PANOPTES_PT_statistics, PANOPTES_PT_passes, PANOPTES_PT_light)


def register():
    """Register the panels and enter the engine into Blender's own."""
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    for engines in _honoured_panels():
        engines.add(ENGINE)


def unregister():
    """Undo `register`."""
    for engines in _honoured_panels():
        engines.discard(ENGINE)
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
