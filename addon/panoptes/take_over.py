# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that carries a scene's settings for Cycles over to Panoptes."""

import bpy

from . import compat

_DISABLED = ("The Cycles add-on is disabled, so its settings cannot be read; nothing was taken over. "
             'Enable it in the Preferences and try again.')


def _words(names):
    """Return 'a, b and c'."""
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def take_over(scene):
    """Copy what has a counterpart from `scene.cycles` to `scene.panoptes`.

    Returns the artist's names of what was copied and of what has been changed in Cycles but has no
    counterpart here. Raises AttributeError where the Cycles add-on is disabled.
    """
    cycles, ours = scene.cycles, scene.panoptes
    ours.samples = cycles.samples
    ours.viewport_samples = max(cycles.preview_samples, 1)
    ours.first_sample = compat.cycles_first_sample(cycles)
    ours.noise_threshold = cycles.adaptive_threshold if cycles.use_adaptive_sampling else 0.0
    ours.time_budget = cycles.time_limit
    ours.seed = cycles.seed
    ours.bounces = cycles.max_bounces
    for kind in ('diffuse', 'glossy', 'transmission'):
        setattr(ours.primitive, f'{kind}_bounces', getattr(cycles, f'{kind}_bounces'))
    # Real-time's bounces are all diffuse. More than its own few would show little and take long.
    cache = ours.radiance_cache
    cache.bounces = min(cycles.diffuse_bounces, cache.bl_rna.properties['bounces'].default)
    ours.primitive.transparent_bounces = cycles.transparent_max_bounces
    ours.primitive.clamp_direct = cycles.sample_clamp_direct
    ours.primitive.clamp_indirect = cycles.sample_clamp_indirect
    ours.primitive.filter_glossy = cycles.blur_glossy
    ours.exposure = cycles.film_exposure
    scene.render.filter_size = cycles.filter_width
    # Cycles denoises no 3D View by default, whose pictures have not begun smooth: ours stay as they are.
    ours.denoise.final = cycles.use_denoising
    for layer in scene.view_layers:
        layer.panoptes.use_pass_sample_count = layer.cycles.pass_debug_sample_count
    taken = ['samples', 'viewport samples', 'noise threshold', 'time limit', 'seed', 'bounces', 'clamping',
             'filter glossy', 'denoising', 'exposure', 'pixel filter width']
    # Transparent film is one switch of Blender's for both engines.
    return taken, list(_without_counterpart(scene, cycles))


def _without_counterpart(scene, cycles):
    """Yield names of settings that would change Cycles' picture, and which we do not have."""
    if cycles.pixel_filter_type != 'BLACKMAN_HARRIS':
        yield f'{cycles.pixel_filter_type.title()} filter (Blackman-Harris is used)'
    if not (cycles.caustics_reflective and cycles.caustics_refractive):
        yield 'no caustics'
    if cycles.use_fast_gi:
        yield 'fast GI'
    if cycles.use_animated_seed:
        yield 'animated seed'
    if scene.render.film_transparent and cycles.film_transparent_glass:
        yield 'transparent glass'
    if scene.render.use_motion_blur:
        yield 'motion blur'


class PANOPTES_OT_take_over_cycles(bpy.types.Operator):
    """Copy samples, limits, bounces, clamping, denoising, exposure and pixel filter from this scene's settings for Cycles"""

    bl_idname = 'panoptes.take_over_cycles'
    bl_label = "Take over Cycles' Settings"
    bl_options = {'REGISTER', 'UNDO'}

    def execute(self, context):
        """Copy, and report in a sentence."""
        if not hasattr(context.scene, 'cycles'):
            self.report({'WARNING'}, _DISABLED)
            return {'CANCELLED'}
        taken, missing = take_over(context.scene)
        rest = f'; without a counterpart: {_words(missing)}' if missing else ''
        self.report({'INFO'}, f'Taken over: {_words(taken)}{rest}.')
        return {'FINISHED'}
