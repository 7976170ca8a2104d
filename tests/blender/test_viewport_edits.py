# SPDX-License-Identifier: GPL-3.0-or-later
"""A 3D View in Rendered shading follows every edit, to the bits of an engine that has never seen the scene before.

Bits are compared where light is Real-time's without the radiance cache: all of it depends on the seed alone. With the
cache, and by paths, the means of blocks are. PANOPTES_LONG_TESTS walks through five hundred edits instead of forty, and
makes all edits in any light.
"""

import json
import os
import shutil
import subprocess

import bpy
import pytest

from edit_list import ACTIONS, APART, SOME
from edit_scene import FLOOR_SIDE, IMAGE_SIDE

HERE = os.path.dirname(os.path.abspath(__file__))
LONG = os.environ.get('PANOPTES_LONG_TESTS', '') != ''
STEPS = 500 if LONG else 40
# Frames' own blocks, small meshes and tables: less than the floor's positions alone.
SMALL = 24 * 1024
# With its mipmaps.
IMAGE = IMAGE_SIDE ** 2 * 4 * 4 // 3

pytestmark = [
    pytest.mark.skipif(not (shutil.which('xvfb-run') and shutil.which('xauth')),
                       reason='needs xvfb-run and xauth'),
    pytest.mark.skipif(os.environ.get('PANOPTES_TEST_FAST', '') != '', reason='takes a minute'),
]


def edit_in_window(out, *words, limit=300):
    """Run edit_steps.py in a Blender with a window; return {step: what it saw} and Blender's output."""
    done = subprocess.run(
        ['xvfb-run', '-a', '-s', '-screen 0 900x600x24', bpy.app.binary_path, '--factory-startup', '--window-geometry',
         '0', '0', '640', '480', '-P', os.path.join(HERE, 'edit_steps.py'), '--', str(out), *words],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=limit, check=False)
    assert out.exists() and done.returncode == 0, done.stdout
    return json.loads(out.read_text()), done.stdout


@pytest.fixture(scope='module')
def edited(native_module, tmp_path_factory):
    """What each edit of edit_steps.py has led to, and Blender's output."""
    return edit_in_window(tmp_path_factory.mktemp('edits') / 'shown.json', 'edits', 'direct')


@pytest.fixture(scope='module')
def walked(native_module, tmp_path_factory):
    """What a walk of edits by chance has led to, and Blender's output."""
    return edit_in_window(tmp_path_factory.mktemp('walk') / 'shown.json', 'walk', 'direct', str(STEPS), '1',
                          limit=3600 if LONG else 300)


@pytest.fixture(scope='module', params=list(APART))
def edited_in_light(request, native_module, tmp_path_factory):
    """(light, what edits have led to, Blender's output) for each light that is compared by means."""
    some = () if LONG else ('some',)
    return (request.param, *edit_in_window(tmp_path_factory.mktemp(request.param) / 'shown.json', 'edits', request.param,
                                           *some, limit=3600 if LONG else 300))


def names(edits=ACTIONS):
    """Return the names of the steps, which edit_steps.py numbers."""
    return [f'{number:02} {name}' for number, name in enumerate(edits)]


def assert_fresh(step):
    """All views of a step show what a fresh engine shows, and that is a picture."""
    for view in step['views']:
        assert view['differing'] == 0, view
        assert view['mean'] > 0.01


@pytest.mark.parametrize('name', names())
def test_view_follows(edited, name):
    found, output = edited
    assert found.get(name) is not None, output
    if name.split()[1].startswith('play'):
        # Playback goes on; what it has led to is looked at where it is stopped.
        assert found[name] > 1
        return
    assert_fresh(found[name])
    # A picture that no edit changes would always be fresh; in Solid shading there is none.
    assert found[name]['changed'] or not found[name]['views']


@pytest.mark.parametrize('name', [n for n in names(ACTIONS if LONG else SOME) if not n.split()[1].startswith('play')])
def test_view_follows_in_any_light(edited_in_light, name):
    light, found, output = edited_in_light
    step = found.get(name)
    assert step is not None, output
    for view in step['views']:
        assert view['apart'] < APART[light], view
    # What was shown before such an edit would not have passed.
    if not LONG:
        assert step['moved'] > 2.0 * APART[light]


@pytest.mark.parametrize('name', [n for n in names() if not n.split()[1].startswith('play')])
def test_edit_sends_no_more_than_it_touched(edited, name):
    found, _ = edited
    # Each picture that was begun sends its own blocks, whatever was edited.
    pictures = max(found[name]['samples'] // 2, 1)
    # An image that no material used comes back with the material that does.
    due = pictures * SMALL + (IMAGE if name.split()[1] in ('undo', 'redo', 'relink') else 0)
    assert FLOOR_SIDE ** 2 * 12 > SMALL
    assert found[name]['uploaded_bytes'] <= due


def test_views_were_two_while_the_area_was_split(edited):
    found, _ = edited
    name = next(n for n in names() if n.endswith('split_view'))
    assert len(found[name]['views']) == 2


def test_nothing_was_raised(edited, walked, edited_in_light):
    for *_, output in (edited, walked, edited_in_light):
        assert 'Traceback' not in output and 'addon/panoptes/' not in output, output


def test_walk_stays_fresh(walked):
    found, output = walked
    compared = [step for name, step in found.items() if name.isdigit() and 'views' in (step or {})]
    assert len(compared) == STEPS // 10, output
    for step in compared:
        assert_fresh(step)
    assert sum(len(step['views']) for step in compared) >= len(compared) // 2


@pytest.mark.skipif(not LONG, reason='memory grows too little to tell in a short walk')
def test_memory_of_a_long_walk_settles(walked):
    found, _ = walked
    resident = [found[str(step)]['resident'] for step in range(STEPS)]
    assert max(resident[-100:]) < 1.05 * max(resident[-200:-100])
