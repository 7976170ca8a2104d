# SPDX-License-Identifier: GPL-3.0-or-later
"""Applying command-line options to a scene's `panoptes` settings."""

import bpy

from .failure import Failure


def apply(options, scene):
    """Set what the options ask for; raises `Failure`."""
    settings = scene.panoptes
    if options.method is not None:
        settings.method = options.method
    if options.samples is not None:
        first, last, _ = options.samples
        _assign(settings, 'first_sample', str(first))
        _assign(settings, 'samples', str(last - first))
    if options.bounces is not None:
        # Real-time's own limit would come before one that is asked for.
        cache = settings.radiance_cache
        cache.bounces = min(options.bounces, cache.bl_rna.properties['bounces'].hard_max)
    for name in ('bounces', 'seed', 'time_budget', 'noise_threshold'):
        value = getattr(options, name)
        if value is not None:
            _assign(settings, name, str(value))
    if options.force_all_effects:
        settings.force_all_effects = True
    for key, value in options.assignments:
        _assign(settings, key, value)
    if options.size is not None:
        render = scene.render
        render.resolution_x, render.resolution_y = options.size
        render.resolution_percentage = 100
        # Blender keeps at least 4 pixels a side, silently.
        if (render.resolution_x, render.resolution_y) != options.size:
            raise Failure(f'Blender cannot render {options.size[0]}x{options.size[1]}; the least is '
                          f'{render.resolution_x}x{render.resolution_y}.')
    if options.frame is not None:
        scene.frame_set(options.frame)


def _keys(group, prefix=''):
    """Return all keys of a property group, dotted for groups inside."""
    found = []
    for prop in group.bl_rna.properties:
        if prop.identifier in ('rna_type', 'name', 'last_stats'):
            continue
        inner = getattr(group, prop.identifier)
        if isinstance(inner, bpy.types.PropertyGroup):
            found += _keys(inner, f'{prefix}{prop.identifier}.')
        else:
            found.append(prefix + prop.identifier)
    return found


def _assign(settings, key, text):
    """Set one property from text; raises `Failure` naming the key and what it takes."""
    if key not in _keys(settings):
        raise Failure(f"'{key}' is not an option; there are {', '.join(_keys(settings))}.")
    group = settings
    *groups, name = key.split('.')
    for part in groups:
        group = getattr(group, part)
    prop = group.bl_rna.properties[name]
    setattr(group, name, _value(prop, key, text))


def _value(prop, key, text):
    if prop.type == 'ENUM':
        choices = [item.identifier for item in prop.enum_items]
        if text not in choices:
            raise Failure(f"'{text}' is no value of {key}; there are {', '.join(choices)}.")
        return text
    if prop.type == 'BOOLEAN':
        words = {'1': True, 'true': True, 'on': True, '0': False, 'false': False, 'off': False}
        if text.lower() not in words:
            raise Failure(f"'{text}' is no value of {key}; give true or false.")
        return words[text.lower()]
    if prop.type == 'POINTER':
        # Of the data-blocks only collections can be chosen.
        found = bpy.data.collections.get(text)
        if found is None:
            raise Failure(f"There is no collection '{text}' for {key}; give the name of one.")
        return found
    if prop.type == 'STRING':
        return text
    try:
        number = int(text) if prop.type == 'INT' else float(text)
    except ValueError:
        kind = 'a whole number' if prop.type == 'INT' else 'a number'
        raise Failure(f"'{text}' is no value of {key}; give {kind}.") from None
    if not prop.hard_min <= number <= prop.hard_max:
        raise Failure(f'{key}={text} is out of range; give {prop.hard_min:g} to {prop.hard_max:g}.')
    return number
