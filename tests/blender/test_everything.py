# SPDX-License-Identifier: GPL-3.0-or-later
"""blend_scenes/everything.blend: all that a scene can hold, whole or broken, renders and is reported."""

import os
import re

import bpy
import numpy as np
import pytest

from conftest import ROOT
from panoptes import native, session
from panoptes.sync import SceneSync
from test_cli import run
from test_engine import render_combined

FILE = os.path.join(ROOT, 'blend_scenes', 'everything.blend')

# What is broken in the file itself, by data-block and a word of the sentence about it. Whatever else is
# reported is something that Panoptes cannot do yet.
BROKEN = {'lost': 'cannot be read', 'not a number': 'not numbers'}


@pytest.fixture
def everything(native_module):
    """The file, set to a small picture."""
    native.use_factory(None)
    bpy.ops.wm.open_mainfile(filepath=FILE)
    scene = bpy.context.scene
    scene.render.engine = 'PANOPTES'
    scene.render.resolution_x, scene.render.resolution_y = 160, 90
    scene.render.resolution_percentage = 100
    scene.panoptes.samples = 1
    scene.panoptes.realtime.shadow_resolution = 128
    session.start_final()
    session.final_sync = SceneSync()
    return scene


def test_file_is_small():
    assert os.path.getsize(FILE) < 1 << 20


def test_warnings_are_sentences_about_things_of_the_scene(everything):
    bpy.ops.render.render()
    warnings = session.last_stats['warnings']
    for name, words in BROKEN.items():
        assert len([w for w in warnings if f"'{name}'" in w and words in w]) == 1
    names = {data.name for blocks in (bpy.data.objects, bpy.data.materials, bpy.data.lights,
                                      bpy.data.worlds) for data in blocks}
    for sentence in warnings:
        assert sentence[0].isupper() and sentence.endswith('.') and '\n' not in sentence
        assert re.search(r"'([^']+)'", sentence).group(1) in names
        assert (' yet' in sentence or 'instead' in sentence
                or any(f"'{name}'" in sentence for name in BROKEN))
    assert len(set(warnings)) == len(warnings)


def test_what_is_hidden_or_broken_takes_nothing_else_away(everything, tmp_path):
    picture = render_combined(everything, tmp_path)
    assert np.isfinite(picture).all() and (picture[..., 3] == 1.0).all()
    # The broken ones may be missing; without any of them the rest is the same.
    for name in ('not a number', 'no area', 'empty mesh', 'edges only', 'flattened', 'excluded',
                 'hidden in renders', 'speaker', 'wind', 'probe', 'mark'):
        bpy.data.objects.remove(bpy.data.objects[name])
    rest = render_combined(everything, tmp_path)
    changed = (np.abs(rest - picture)[..., :3].max(axis=2) > 0.05).mean()
    assert changed < 0.02


def test_frames_differ_where_something_moves(everything, tmp_path):
    pictures = []
    for frame in (1, 2, 3):
        everything.frame_set(frame)
        pictures.append(render_combined(everything, tmp_path))
        assert np.isfinite(pictures[-1]).all() and not session.last_error
    for one, other in zip(pictures, pictures[1:]):
        changed = (np.abs(one - other)[..., :3].max(axis=2) > 0.02).mean()
        assert 0.001 < changed < 0.1


@pytest.mark.parametrize('method', ['auto', 'realtime', 'fragment', 'primitive'])
def test_every_method_renders(everything, method):
    everything.panoptes.method = method
    bpy.ops.render.render()
    assert session.last_stats['samples'] == 1 and not session.last_error


def test_command_line_ends_with_status_0(native_module, tmp_path):
    path = tmp_path / 'picture.png'
    status, lines, output = run('render', FILE, '-o', path, '--size', '96x54', '--samples', '1',
                                '--frame', '2', '--set', 'realtime.shadow_resolution=128')
    assert status == 0, output
    assert path.stat().st_size > 1000
    assert any("'lost'" in line for line in lines)
