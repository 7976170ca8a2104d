# SPDX-License-Identifier: GPL-3.0-or-later
"""Render passes: Blender's names, channels and switches, and which method fills them."""

from typing import NamedTuple


class Pass(NamedTuple):
    """A pass by Blender's name.

    `switch` is its property of a view layer, dotted for one of ours ('' = always on). `paths` marks
    what only paths of light find. Blender makes room by itself for all passes but those that are
    `ours`.
    """

    name: str
    channels: int
    channel_ids: str
    kind: str
    switch: str
    paths: bool = False
    ours: bool = False

    def owner(self, view_layer):
        """Return (object, property) of the switch."""
        *groups, name = self.switch.split('.')
        for group in groups:
            view_layer = getattr(view_layer, group)
        return view_layer, name

    def wanted(self, view_layer):
        """Tell whether a view layer asks for it."""
        return not self.switch or getattr(*self.owner(view_layer))


PASSES = (
    Pass('Combined', 4, 'RGBA', 'COLOR', ''),
    Pass('Depth', 1, 'Z', 'VALUE', 'use_pass_z'),
    Pass('Position', 3, 'XYZ', 'VECTOR', 'use_pass_position', paths=True),
    Pass('Normal', 3, 'XYZ', 'VECTOR', 'use_pass_normal'),
    Pass('DiffDir', 3, 'RGB', 'COLOR', 'use_pass_diffuse_direct'),
    Pass('DiffInd', 3, 'RGB', 'COLOR', 'use_pass_diffuse_indirect'),
    Pass('DiffCol', 3, 'RGB', 'COLOR', 'use_pass_diffuse_color'),
    Pass('GlossDir', 3, 'RGB', 'COLOR', 'use_pass_glossy_direct'),
    Pass('GlossInd', 3, 'RGB', 'COLOR', 'use_pass_glossy_indirect'),
    Pass('GlossCol', 3, 'RGB', 'COLOR', 'use_pass_glossy_color'),
    Pass('TransDir', 3, 'RGB', 'COLOR', 'use_pass_transmission_direct'),
    Pass('TransInd', 3, 'RGB', 'COLOR', 'use_pass_transmission_indirect'),
    Pass('TransCol', 3, 'RGB', 'COLOR', 'use_pass_transmission_color'),
    Pass('Emit', 3, 'RGB', 'COLOR', 'use_pass_emit'),
    Pass('Env', 3, 'RGB', 'COLOR', 'use_pass_environment'),
    Pass('AO', 3, 'RGB', 'COLOR', 'use_pass_ambient_occlusion'),
    # The name that it has in Cycles, which makes room for it just so.
    Pass('Debug Sample Count', 1, 'X', 'VALUE', 'panoptes.use_pass_sample_count', paths=True, ours=True),
    # That of Cycles, too.
    Pass('Noisy Image', 4, 'RGBA', 'COLOR', 'panoptes.use_pass_noisy_image', paths=True, ours=True),
)
BY_NAME = {entry.name: entry for entry in PASSES}


def filled_by(method):
    """Return the passes that a method ('realtime', 'fragment' or 'primitive') fills; others stay black."""
    return [p for p in PASSES if method != 'realtime' or not p.paths]


def enabled(view_layer):
    """Return the passes that a view layer asks for."""
    return [p for p in PASSES if p.wanted(view_layer)]


def enable_all(view_layer, method):
    """Switch on every pass that a method fills, and that is not the copy of another."""
    denoises = view_layer.id_data.panoptes.denoise.final
    for entry in filled_by(method):
        if entry.switch and (denoises or entry.name != 'Noisy Image'):
            setattr(*entry.owner(view_layer), True)
