# SPDX-License-Identifier: GPL-3.0-or-later
"""Which rays see an object, as bits, and what an object asks for that is not supported."""

CAMERA, DIFFUSE, GLOSSY, TRANSMISSION, VOLUME_SCATTER, SHADOW = 1, 2, 4, 8, 16, 32
ALL = 63


def _switches(thing):
    # Written out, since ten thousand objects are asked.
    return (thing.visible_camera * CAMERA | thing.visible_diffuse * DIFFUSE
            | thing.visible_glossy * GLOSSY | thing.visible_transmission * TRANSMISSION
            | thing.visible_volume_scatter * VOLUME_SCATTER | thing.visible_shadow * SHADOW)


def rays(thing, maker, view_layer, warn):
    """Return the bits of an instance's evaluated object.

    `maker` is the object that makes the instance, or the object itself: as in Cycles both have to be
    visible, and the maker's collections decide about holdouts and indirect-only objects.
    """
    bits = _switches(thing)
    if maker != thing:
        bits &= _switches(maker)
    if thing.is_holdout or maker.is_holdout or maker.holdout_get(view_layer=view_layer):
        warn(f"Object '{thing.name}' is a holdout, which is not supported yet; it is rendered as a "
             'plain object.')
    elif maker.indirect_only_get(view_layer=view_layer):
        bits &= ~CAMERA
    if thing.is_shadow_catcher or maker.is_shadow_catcher:
        warn(f"Object '{thing.name}' is a shadow catcher, which is not supported yet; it is rendered "
             'as a plain object.')
    return bits


def has_hair(thing):
    """Tell whether an object has hair particles that are rendered as paths."""
    # Most objects have no particles at all, and this answers at once.
    return len(thing.particle_systems) > 0 and any(
        modifier.type == 'PARTICLE_SYSTEM' and modifier.particle_system.settings.type == 'HAIR'
        and modifier.particle_system.settings.render_type == 'PATH' for modifier in thing.modifiers)
