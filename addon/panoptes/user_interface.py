# SPDX-License-Identifier: GPL-3.0-or-later
"""Registers panels, ours and those of Blender that Panoptes honours, and the operator."""

import bpy

from . import compat, data_panels, honoured, indirect_panels, panels, take_over
from .engine_panel import ENGINE

_CLASSES = (take_over.PANOPTES_OT_take_over_cycles, *panels.CLASSES, *data_panels.CLASSES,
            *indirect_panels.OBJECT_CLASSES)


def register():
    """Register our panels and enter the engine into Blender's own panels and node menus."""
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    honoured.enter(ENGINE)
    compat.offer_shader_nodes(ENGINE)


def unregister():
    """Undo `register`."""
    compat.withdraw_shader_nodes()
    honoured.leave(ENGINE)
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
