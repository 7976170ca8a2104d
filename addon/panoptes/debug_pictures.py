# SPDX-License-Identifier: GPL-3.0-or-later
"""Which picture `scene.panoptes.debug_picture` asks for: one of a technique of Real-time, or one of rays."""

# Pictures whose names begin so are of these techniques; the others show rays at work.
OCCLUSION, CACHE = 'occlusion_', 'cache_'


def of_technique(settings, prefix):
    """Return which picture of a technique `scene.panoptes` asks for; 'none' for the scene or another picture."""
    chosen = settings.debug_picture
    return chosen[len(prefix):] if chosen.startswith(prefix) else 'none'


def shows_technique(settings):
    """Tell whether `scene.panoptes` asks for a picture of a technique, which is of that in Real-time."""
    return settings.debug_picture.startswith((OCCLUSION, CACHE))


def shows_rays(settings):
    """Tell whether `scene.panoptes` asks for a picture of rays at work."""
    return settings.debug_picture != 'none' and not shows_technique(settings)
