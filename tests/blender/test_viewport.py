# SPDX-License-Identifier: GPL-3.0-or-later
"""The 3D View in a Blender with a window, on a virtual display."""

import json
import os
import re
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


def walk(script, out):
    """Run a script of steps in a Blender with a window; return what it saw, and Blender's output."""
    done = subprocess.run(
        ['xvfb-run', '-a', '-s', '-screen 0 900x600x24', bpy.app.binary_path, '--factory-startup',
         '--window-geometry', '0', '0', '900', '600', '-P', os.path.join(HERE, script), '--', str(out)],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=500, check=False)
    assert out.exists(), done.stdout
    found = json.loads(out.read_text())
    found['output'] = done.stdout
    return found


@pytest.fixture(scope='module')
def shown(native_module, tmp_path_factory):
    """What viewport_steps.py saw, and Blender's output."""
    return walk('viewport_steps.py', tmp_path_factory.mktemp('viewport') / 'shown.json')


@pytest.fixture(scope='module')
def views(native_module, tmp_path_factory):
    """What views_steps.py saw, and Blender's output."""
    return walk('views_steps.py', tmp_path_factory.mktemp('views') / 'shown.json')


def test_world_is_shown(shown):
    assert shown['start'][:3] == pytest.approx([0.0, 0.5, 0.0], abs=1e-3), shown['output']


def test_edit_of_the_world_redraws(shown):
    assert shown['world'][:3] == pytest.approx([0.0, 0.0, 1.0], abs=1e-3)


def test_added_object_appears(shown):
    assert shown['plane'][:3] != pytest.approx(shown['world'][:3], abs=1e-3)


def test_paths_end_with_what_real_time_began(shown):
    # Light of the world on an open plane is the same by both, and by so many samples hardly noisy on the mean.
    *color, _, _, status = shown['paths']
    # How many samples it took to look depends on how busy the machine is.
    assert color == pytest.approx(shown['no debug'][:3], rel=0.02, abs=1e-3)
    assert re.fullmatch(r'Paths: \d+ samples', status)
    assert shown['no paths'][:3] == pytest.approx(shown['no debug'][:3], abs=1e-3)


def test_turned_view_redraws(shown):
    # The plane fills the view now and is lit by the world alone.
    assert shown['turned'][:3] != pytest.approx(shown['plane'][:3], abs=1e-3)
    assert shown['turned'][2] > shown['turned'][0]


def test_debug_picture_replaces_the_scene_while_asked_for(shown):
    assert shown['debug'][:3] != pytest.approx(shown['turned'][:3], abs=1e-2)
    assert shown['no debug'] == pytest.approx(shown['turned'], abs=1e-6)


def test_bent_normals_are_shown(shown):
    # The plane is open straight upwards.
    assert shown['bent normals'][:3] == pytest.approx([0.5, 0.5, 1.0], abs=0.05)


def test_final_render_beside_the_viewport(shown):
    assert shown['final'] == [64, 48]


def test_error_is_shown_as_status(shown):
    assert shown['without engine'] == 'There is no driver; install one.'


def test_viewport_recovers(shown):
    assert shown['again'] is not None and shown['solid']


def test_nothing_was_raised(shown):
    assert 'addon/panoptes/' not in shown['output'], shown['output']


def test_two_views_show_their_own(views):
    below, level = views['split']
    # One sees the floor alone but for the cube, the other the horizon; both are refined to the end.
    assert below[0] > 0.9 and below[1] == 0.0, views['output']
    assert level[0] == pytest.approx(0.5, abs=0.1) and level[1] == pytest.approx(0.5, abs=0.1)


def test_local_view_is_that_of_one_view(views):
    assert views['local'] == [False, True]


def test_color_management_restarts_nothing(views):
    assert views['transform'] == 0


def test_selection_restarts_nothing(views):
    assert views['selected'] == 0


def test_borders(views):
    whole = {tuple(size) for size in views['no border']['regions']}
    left, bottom, width, height, columns, rows = views['camera border']['pictures'][1]
    # Half of a frame of 4 to 3, within the region.
    assert width / height == pytest.approx(0.5 * 64 / 48, rel=0.02) and left > 0 and bottom > 0
    assert (columns, rows) == (width, height)
    region = views['view border']['regions'][1]
    assert views['view border']['pictures'][1][2:4] == pytest.approx([s / 2 for s in region], abs=1)
    assert {tuple(found[2:4]) for found in views['no border']['pictures']} == whole


def test_resized_regions_are_filled(views):
    sizes = sorted(map(tuple, views['resized']['regions']))
    assert sizes != sorted(map(tuple, views['no border']['regions']))
    assert sorted(tuple(found[4:]) for found in views['resized']['pictures']) == sizes


def test_previews(views):
    found = views['previews']
    # Icons are encoded sRGB; the sphere covers a part of its picture.
    red, green, blue, alpha = found['Material']
    assert 0.3 < alpha < 0.8 and green > 1.5 * max(red, blue)
    assert found['World'] == pytest.approx([0.0, 1.0, 0.0, 1.0], abs=0.01)
    assert found['AreaLight'][0] > 0.1 and found['AreaLight'][3] == 1.0


def test_previews_disturb_neither_views_nor_final_renders(views):
    assert views['after previews'] == {'jobs': 0, 'size': [64, 48]}


def test_views_come_back_from_material_preview(views):
    assert [v[:3] for v in views['icons']] == [pytest.approx(v[:3], abs=0.02) for v in views['resized means']]


def test_warnings_reach_the_artist(views):
    (text,) = views['warned']
    assert 'nowhere.exr' in text and 'magenta' in text


def test_nothing_was_raised_by_several_views(views):
    assert 'addon/panoptes/' not in views['output'], views['output']
