# SPDX-License-Identifier: GPL-3.0-or-later
"""Which of Blender's own panels appear when Panoptes is the engine.

An engine gets none of Blender's panels by itself: each lists the engines that it serves. Panels that
serve 'BLENDER_RENDER', which is no engine any more, edit the scene's data whatever renders it
(modifiers, physics, particles, textures, lenses, files): they are honoured unless `_IGNORED` names
them. Panels of EEVEE or Cycles belong to those engines and are left to them, except those of
`_BORROWED`, which edit only what Panoptes follows too.
"""

import bpy

# Panels of EEVEE whose every setting counts here; lenses have theirs with EEVEE and Workbench.
_BORROWED = {
    'DATA_PT_camera_dof',
    'DATA_PT_camera_dof_aperture',
    'EEVEE_MATERIAL_PT_context_material',
    'EEVEE_MATERIAL_PT_surface',
    'EEVEE_WORLD_PT_surface',
    'MATERIAL_PT_preview',
}

# Engine-neutral panels, or families of them by the beginning of their names, whose settings do not
# count here: (name, why).
_IGNORED = (
    ('DATA_PT_light', 'our own Light panel shows what counts'),
    ('DATA_PT_spot', 'our own Light panel shows what counts'),
    ('DATA_PT_area', 'our own Light panel shows what counts'),
    ('NODE_DATA_PT_light', 'our own Light panel shows what counts'),
    ('DATA_PT_falloff_curve', 'lamps fall off as in nature'),
    ('DATA_PT_lightprobe', 'probes belong to EEVEE'),
    ('DATA_PT_volume_render', 'volumes are not rendered yet'),
    ('PARTICLE_PT_hair_shape', 'hair is not rendered yet'),
    ('PARTICLE_PT_render_path', 'hair is not rendered yet'),
    ('DATA_PT_camera_stereoscopy', 'one eye is rendered'),
    ('RENDER_PT_stereoscopy', 'one eye is rendered'),
    ('RENDER_PT_output_views', 'one eye is rendered'),
    ('OBJECT_PT_visibility', 'it offers holdouts; our own Visibility panel shows what counts'),
    ('OBJECT_PT_shading', 'light linking and shadow offsets are not supported'),
    ('OBJECT_PT_shadow_terminator', 'light linking and shadow offsets are not supported'),
)


def ignored(name):
    """Return why a panel of this name is ignored, or ''."""
    return next((why for start, why in _IGNORED if name.startswith(start)), '')


def _panels():
    """Yield every registered panel class that lists engines, once."""
    seen = set()
    waiting = [bpy.types.Panel]
    while waiting:
        for panel in waiting.pop().__subclasses__():
            if panel in seen:
                continue
            seen.add(panel)
            waiting.append(panel)
            # Where a class names no engines of its own it shares its base's.
            if 'COMPAT_ENGINES' in vars(panel):
                yield panel


def honours(panel):
    """Tell whether a panel of Blender's shall appear for Panoptes."""
    if panel.__name__ in _BORROWED:
        return True
    return 'BLENDER_RENDER' in panel.COMPAT_ENGINES and not ignored(panel.__name__)


def enter(engine):
    """Add an engine's id to all panels that it honours."""
    for panel in _panels():
        if honours(panel):
            panel.COMPAT_ENGINES.add(engine)


def leave(engine):
    """Undo `enter`."""
    for panel in _panels():
        panel.COMPAT_ENGINES.discard(engine)
