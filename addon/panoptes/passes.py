# SPDX-License-Identifier: GPL-3.0-or-later
"""Render passes: Blender's names, channels and switches."""

from typing import NamedTuple


class Pass(NamedTuple):
    """A pass by Blender's name; `switch` is its property of a view layer ('' = always on)."""

    name: str
    channels: int
    channel_ids: str
    kind: str
    switch: str


PASSES = (
    Pass('Combined', 4, 'RGBA', 'COLOR', ''),
    Pass('Depth', 1, 'Z', 'VALUE', 'use_pass_z'),
    Pass('Normal', 3, 'XYZ', 'VECTOR', 'use_pass_normal'),
    Pass('DiffDir', 3, 'RGB', 'COLOR', 'use_pass_diffuse_direct'),
    Pass('DiffCol', 3, 'RGB', 'COLOR', 'use_pass_diffuse_color'),
    Pass('GlossDir', 3, 'RGB', 'COLOR', 'use_pass_glossy_direct'),
    Pass('GlossCol', 3, 'RGB', 'COLOR', 'use_pass_glossy_color'),
    Pass('Emit', 3, 'RGB', 'COLOR', 'use_pass_emit'),
    Pass('Env', 3, 'RGB', 'COLOR', 'use_pass_environment'),
)
BY_NAME = {entry.name: entry for entry in PASSES}


def enabled(view_layer):
    """Return the passes that a view layer asks for."""
    return [p for p in PASSES if not p.switch or getattr(view_layer, p.switch)]


def enable_all(view_layer):
    """Switch on every pass that Panoptes knows."""
    for entry in PASSES:
        if entry.switch:
            setattr(view_layer, entry.switch, True)
