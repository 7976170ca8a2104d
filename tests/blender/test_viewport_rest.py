# SPDX-License-Identifier: GPL-3.0-or-later
"""A 3D View that has finished takes no time; files are opened one after the other; Blender ends when it is told to."""

import json
import os
import shutil
import subprocess

import bpy
import pytest

HERE = os.path.dirname(os.path.abspath(__file__))
SCENES = os.path.join(os.path.dirname(os.path.dirname(HERE)), 'blend_scenes')
# The first comes back at the end: all that the others needed is to be gone by then.
FILES = ('two_spots', 'canyon', 'doorway', 'confined', 'colonnade', 'atrium', 'doorway', 'canyon', 'confined',
         'two_spots')

pytestmark = [
    pytest.mark.skipif(not (shutil.which('xvfb-run') and shutil.which('xauth')),
                       reason='needs xvfb-run and xauth'),
    pytest.mark.skipif(os.environ.get('PANOPTES_TEST_FAST', '') != '', reason='takes half a minute'),
]


def window(out, *words):
    """Run rest_steps.py in a Blender with a window; return {step: what it saw} and Blender's output."""
    done = subprocess.run(
        ['xvfb-run', '-a', '-s', '-screen 0 640x480x24', bpy.app.binary_path, '--factory-startup', '--window-geometry',
         '0', '0', '640', '480', '-P', os.path.join(HERE, 'rest_steps.py'), '--', str(out), *words],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=300, check=False)
    assert out.exists() and done.returncode == 0, done.stdout
    assert 'Traceback' not in done.stdout, done.stdout
    return json.loads(out.read_text()), done.stdout


def test_a_finished_view_takes_no_time(native_module, tmp_path):
    found, output = window(tmp_path / 'out.json', 'rest')
    assert found['start'] is not None, output
    # What Blender takes by itself, and the test's own questions, are in both.
    assert found['rendered'] < found['solid'] + 0.03, found


def test_files_opened_one_after_the_other(native_module, tmp_path):
    found, output = window(tmp_path / 'out.json', 'files', *(os.path.join(SCENES, f'{name}.blend') for name in FILES))
    opened = [found.get(f'{n} {name}.blend') for n, name in enumerate(FILES)]
    assert all(opened), output
    for one, name in zip(opened, FILES):
        again = opened[FILES.index(name)]
        assert one['color'] == pytest.approx(again['color'], rel=1e-3), name
    assert len({tuple(round(c, 4) for c in one['color']) for one in opened}) == len(set(FILES))
    # Buffers keep some room to spare, which depends on what was there before.
    assert opened[-1]['memory'] < 1.5 * opened[0]['memory']


def test_blender_ends_while_paths_are_traced(native_module, tmp_path):
    found, output = window(tmp_path / 'out.json', 'quit')
    assert found['paths'], output
    assert 'Blender quit' in output
