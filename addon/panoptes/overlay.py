# SPDX-License-Identifier: GPL-3.0-or-later
"""Statistics in the corner of the 3D Views that ask for them.

Blender calls `draw` for every 3D View at every redraw, and would write whatever is raised to the console
each time: nothing may come out of it.
"""

import bpy

from . import compat, session
from .engine_panel import ENGINE

# Between the text and what stands beside it, and between lines, in letters' height.
_MARGIN, _SPACING = 1.0, 1.4

_handle = None
# What went wrong, so that it is written once.
_failure = ''


def draw():
    """Draw the text of the 3D View that is being drawn, if it wants any. Raises nothing."""
    global _failure
    try:
        _draw(bpy.context)
    except Exception as error:  # whatever it was, the next redraw must not write it again
        if repr(error) != _failure:
            _failure = repr(error)
            session.sentence(error)


def _draw(context):
    space = context.space_data
    if context.engine != ENGINE or not wants_text(space):
        return
    viewport = _viewport(context.region.as_pointer())
    if viewport is None:
        return
    scale = context.preferences.system.ui_scale
    size = context.preferences.ui_styles[0].widget.points * scale
    left, bottom = free_corner(context.region, context.area.regions)
    left, bottom = left + _MARGIN * size, bottom + _MARGIN * size
    # A letter is about half as wide as high.
    letters = int((context.region.width - left) / (0.5 * size))
    compat.draw_text(viewport.statistics(letters), left, bottom, size, _SPACING,
                     compat.view_text_color(context.preferences))


def wants_text(space):
    """Tell whether a 3D View in Rendered shading is to show its statistics."""
    return (space.shading.type == 'RENDERED' and space.overlay.show_overlays
            and space.shading.panoptes.show_statistics)


def _viewport(region):
    """Return the `Viewport` that a region (its address) shows, or None."""
    # The address of a region that was closed can be another's now.
    found = [view for view in list(session.viewports) if view.region == region]
    return max(found, key=lambda view: view.drawn, default=None)


def free_corner(region, others):
    """Return where the lower left corner (x, y) of a region is not covered by others that lie over it."""
    left = bottom = 0
    for other in others:
        over = (other.width > 1 and other.height > 1 and other.x < region.x + region.width
                and other.x + other.width > region.x and other.y < region.y + region.height
                and other.y + other.height > region.y)
        if over and other.type == 'TOOLS' and other.x <= region.x:
            left = max(left, other.x + other.width - region.x)
        elif over and other.type in {'HEADER', 'TOOL_HEADER', 'ASSET_SHELF', 'ASSET_SHELF_HEADER'}:
            if other.y <= region.y:
                bottom = max(bottom, other.y + other.height - region.y)
    return left, bottom


def register():
    """Let Blender draw the text."""
    global _handle
    if _handle is None and not bpy.app.background:
        _handle = bpy.types.SpaceView3D.draw_handler_add(draw, (), 'WINDOW', 'POST_PIXEL')


def unregister():
    """Undo `register`."""
    global _handle
    if _handle is not None:
        bpy.types.SpaceView3D.draw_handler_remove(_handle, 'WINDOW')
        _handle = None
