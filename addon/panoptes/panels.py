# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of the Render and View Layer tabs."""

import json
import textwrap

import bpy

from . import debug_pictures, fragment_tracing, indirect_panels, occlusion_panels, passes, requests, session
from .engine_panel import EnginePanel


class PANOPTES_PT_take_over(EnginePanel, bpy.types.Panel):
    """The way from Cycles' settings to ours."""

    bl_label = 'Panoptes'
    bl_options = {'HIDE_HEADER'}

    def draw(self, context):
        """Draw the panel."""
        self.layout.operator('panoptes.take_over_cycles', icon='IMPORT')


class PANOPTES_PT_sampling(EnginePanel, bpy.types.Panel):
    """Method and samples."""

    bl_label = 'Sampling'

    def draw(self, context):
        """Draw the panel."""
        settings = context.scene.panoptes
        column = self._column()
        column.prop(settings, 'method')
        column.prop(settings, 'samples', text='Render Samples')
        column.prop(settings, 'viewport_samples')
        column.prop(settings, 'viewport_budget')


class PANOPTES_PT_sampling_limits(EnginePanel, bpy.types.Panel):
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


class PANOPTES_PT_denoising(EnginePanel, bpy.types.Panel):
    """Where the noise of paths is taken out, and by what."""

    bl_label = 'Denoise'
    bl_parent_id = 'PANOPTES_PT_sampling'
    bl_options = {'DEFAULT_CLOSED'}

    def draw(self, context):
        """Draw the panel."""
        settings = context.scene.panoptes.denoise
        column = self._column()
        column.prop(settings, 'viewport')
        column.prop(settings, 'final')
        column.prop(settings, 'denoiser')


class PANOPTES_PT_debug(EnginePanel, bpy.types.Panel):
    """Pictures of rays, ambient occlusion and indirect light at work."""

    bl_label = 'Debug'
    bl_parent_id = 'PANOPTES_PT_sampling'
    bl_options = {'DEFAULT_CLOSED'}

    def draw(self, context):
        """Draw the panel."""
        settings = context.scene.panoptes
        column = self._column()
        column.prop(settings, 'debug_picture')
        if debug_pictures.shows_rays(settings) and not _traces_paths(context):
            _draw_structure(column, settings.primitive)


def _traces_paths(context):
    return requests.method(context.scene.panoptes) != 'realtime'


def _draw_structure(column, settings):
    column.prop(settings, 'structure')
    if settings.structure in {'orthographic', 'cube', 'lists'}:
        column.prop(settings, 'tiles')
        column.prop(settings, 'buckets')


class _PathPanel(EnginePanel):
    """Common part of panels that count for paths of light only."""

    @classmethod
    def poll(cls, context):
        """Show the panel where paths are traced."""
        return super().poll(context) and _traces_paths(context)


class PANOPTES_PT_light_paths(_PathPanel, bpy.types.Panel):
    """How far light is followed."""

    bl_label = 'Light Paths'

    def draw(self, context):
        """Draw the panel."""
        self._column().prop(context.scene.panoptes, 'bounces')


class PANOPTES_PT_light_path_kinds(_PathPanel, bpy.types.Panel):
    """Limits for each kind of bounce."""

    bl_label = 'Limits by Kind'
    bl_parent_id = 'PANOPTES_PT_light_paths'
    bl_options = {'DEFAULT_CLOSED'}

    def draw(self, context):
        """Draw the panel."""
        column = self._column()
        for kind in ('diffuse', 'glossy', 'transmission', 'transparent'):
            column.prop(context.scene.panoptes.primitive, f'{kind}_bounces')


class PANOPTES_PT_clamping(_PathPanel, bpy.types.Panel):
    """What is given up for less noise."""

    bl_label = 'Noise Reduction'
    bl_parent_id = 'PANOPTES_PT_light_paths'
    bl_options = {'DEFAULT_CLOSED'}

    def draw(self, context):
        """Draw the panel."""
        column = self._column()
        for name in ('clamp_direct', 'clamp_indirect', 'filter_glossy'):
            column.prop(context.scene.panoptes.primitive, name)


class PANOPTES_PT_rays(_PathPanel, bpy.types.Panel):
    """How rays find what they meet."""

    bl_label = 'Rays'
    bl_options = {'DEFAULT_CLOSED'}

    def draw(self, context):
        """Draw the panel."""
        settings = context.scene.panoptes.primitive
        column = self._column()
        column.prop(settings, 'primary')
        column.prop(settings, 'shadows')
        if requests.method(context.scene.panoptes) == 'fragment':
            fragment_tracing.draw(column, context.scene.panoptes.fragment)
        else:
            _draw_structure(column, settings)


class PANOPTES_PT_shadows(EnginePanel, bpy.types.Panel):
    """Shadow maps: of Real-time, which 3D Views begin with, and of paths that use maps."""

    bl_label = 'Shadow Maps'

    def draw(self, context):
        """Draw the panel."""
        settings = context.scene.panoptes.realtime
        column = self._column()
        column.prop(settings, 'shadow_resolution')
        column.prop(settings, 'soft_shadows')
        if settings.soft_shadows:
            column.prop(settings, 'penumbrae')


class PANOPTES_PT_film(EnginePanel, bpy.types.Panel):
    """Exposure, pixel filter and background."""

    bl_label = 'Film'
    bl_options = {'DEFAULT_CLOSED'}

    def draw(self, context):
        """Draw the panel."""
        column = self._column()
        column.prop(context.scene.panoptes, 'exposure')
        column.prop(context.scene.render, 'filter_size')
        column.prop(context.scene.render, 'film_transparent', text='Transparent')


def _milliseconds(number):
    return f'{number / 1e3:.2f} s' if number >= 1000 else f'{number:.1f} ms'


class PANOPTES_PT_statistics(EnginePanel, bpy.types.Panel):
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


class PANOPTES_PT_warnings(EnginePanel, bpy.types.Panel):
    """What the last final render and the 3D Views could not show as the scene asks for it."""

    bl_label = 'Warnings'

    @staticmethod
    def _sentences(context):
        try:
            stats = json.loads(context.scene.panoptes.last_stats or '{}')
        except ValueError:
            stats = {}
        return list(dict.fromkeys((*stats.get('warnings', ()), *session.viewport_warnings())))

    @classmethod
    def poll(cls, context):
        """Show the panel when there is something to say."""
        return super().poll(context) and bool(cls._sentences(context))

    def draw(self, context):
        """Draw the panel."""
        # A label does not wrap its text; a letter is about a third of a button's height wide.
        letters = max(int(context.region.width / (7 * context.preferences.system.ui_scale)) - 6, 20)
        for sentence in self._sentences(context):
            column = self.layout.column(align=True)
            for index, line in enumerate(textwrap.wrap(sentence, letters)):
                column.label(text=line, icon='BLANK1' if index else 'ERROR')


class PANOPTES_PT_passes(EnginePanel, bpy.types.Panel):
    """Passes of the view layer that Panoptes can render."""

    bl_label = 'Passes'
    bl_context = 'view_layer'

    def draw(self, context):
        """Draw the panel."""
        column = self._column()
        for entry in passes.filled_by(requests.method(context.scene.panoptes)):
            if entry.switch:
                column.prop(*entry.owner(context.view_layer))


CLASSES = (PANOPTES_PT_take_over, PANOPTES_PT_sampling, PANOPTES_PT_sampling_limits,
           PANOPTES_PT_denoising, PANOPTES_PT_debug,
           PANOPTES_PT_light_paths, PANOPTES_PT_light_path_kinds, PANOPTES_PT_clamping, PANOPTES_PT_rays,
           PANOPTES_PT_shadows, *occlusion_panels.CLASSES, *indirect_panels.CLASSES, PANOPTES_PT_film,
           PANOPTES_PT_warnings, PANOPTES_PT_statistics, PANOPTES_PT_passes)
