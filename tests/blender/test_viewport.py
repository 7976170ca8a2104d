# SPDX-License-Identifier: GPL-3.0-or-later
"""The 3D View in a Blender with a window, on a virtual display."""

import json
import os
import shutil
import subprocess

import bpy
import pytest

HERE = os.path.dirname(os.path.abspath(__file__))

pytestmark = [
    pytest.mark.skipif(not (shutil.which('xvfb-run') and shutil.which('xauth')),
                       reason='needs xvfb-run and xauth'),
    pytest.mark.skipif(os.environ.get('PANOPTES_TEST_FAST', '') != '', reason='takes half a minute'),
]


@pytest.fixture(scope='module')
def shown(native_module, tmp_path_factory):
    """What viewport_steps.py saw, and Blender's output."""
    out = tmp_path_factory.mktemp('viewport') / 'shown.json'
    done = subprocess.run(
        ['xvfb-run', '-a', '-s', '-screen 0 800x600x24', bpy.app.binary_path, '--factory-startup',
         '--window-geometry', '0', '0', '800', '600', '-P',
         os.path.join(HERE, 'viewport_steps.py'), '--', str(out)],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=500, check=False)
    assert out.exists(), done.stdout
    found = json.loads(out.read_text())
    found['output'] = done.stdout
    return found


def test_world_is_shown(shown):
    assert shown['start'][:3] == pytest.approx([0.0, 0.5, 0.0], abs=1e-3), shown['output']


def test_edit_of_the_world_redraws(shown):
    assert shown['world'][:3] == pytest.approx([0.0, 0.0, 1.0], abs=1e-3)


def test_added_object_appears(shown):
    assert shown['plane'][:3] != pytest.approx(shown['world'][:3], abs=1e-3)


def test_turned_view_redraws(shown):
    # The plane fills the view now and is lit by the world alone.
    assert shown['turned'][:3] != pytest.approx(shown['plane'][:3], abs=1e-3)
    assert shown['turned'][2] > shown['turned'][0]


def test_final_render_beside_the_viewport(shown):
    assert shown['final'] == [64, 48]


def test_error_is_shown_as_status(shown):
    assert shown['without engine'] == 'There is no driver; install one.'


def test_viewport_recovers(shown):
    assert shown['again'] is not None and shown['solid']


def test_nothing_was_raised(shown):
    assert 'addon/panoptes/' not in shown['output'], shown['output']
