# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes and statistics in the 3D View of a Blender with a window, on a virtual display."""

import re

import pytest

from test_viewport import pytestmark, walk  # noqa: F401


@pytest.fixture(scope='module')
def shown(native_module, tmp_path_factory):
    """What passes_steps.py saw, and Blender's output."""
    return walk('passes_steps.py', tmp_path_factory.mktemp('passes') / 'shown.json')


def test_color_is_flat_albedo(shown):
    assert shown['color']['mean'] == pytest.approx([0.7, 0.4, 0.1], abs=1e-3), shown['output']
    assert shown['color']['spread'] < 1e-3
    # In the light of a green world the plane is something else.
    assert shown['combined']['mean'] == pytest.approx([0.0, 0.2, 0.0], rel=0.02, abs=1e-3)


def test_normals_are_mapped(shown):
    assert shown['normal']['mean'] == pytest.approx([0.5, 0.5, 1.0], abs=1e-3)


def test_direct_light_is_that_of_the_world(shown):
    assert shown['direct']['mean'] == pytest.approx([0.0, 0.5, 0.0], rel=0.02, abs=1e-3)


def test_open_plane_is_open(shown):
    for found in (shown['occlusion'], shown['paths']):
        assert found['mean'] == pytest.approx([1.0, 1.0, 1.0], abs=0.05)


def test_only_what_is_needed_runs(shown):
    assert {'world_light', 'ambient_occlusion'} <= set(shown['color']['skipped'])
    assert not {'world_light', 'ambient_occlusion'} & set(shown['combined']['skipped'])


def test_status_names_the_pass(shown):
    assert shown['combined']['status'] == '4 samples'
    assert shown['color']['status'] == 'Diffuse Color: 4 samples'
    assert shown['paths']['status'] == 'Ambient Occlusion: Paths: 4 samples'
    assert shown['color beside paths']['status'] == 'Diffuse Color: 4 samples'


def test_statistics_are_off_by_default(shown):
    assert shown['no text'] == 0


def test_statistics_tell_of_the_picture(shown):
    lines = shown['text']['lines']
    assert lines[:2] == ['Real-time, 4 samples', 'Estimated error —']
    assert re.match(r'A sample: .*surfaces \d+\.\d ms', lines[2])
    assert lines[3].startswith('Skipped: ') and 'ambient occlusion' in lines[3]
    assert '(the pass that is shown has nothing of it)' in lines[3]
    assert shown['text of paths']['lines'][0] == 'Paths, 4 samples'


def test_text_follows_the_scale_of_the_interface(shown):
    assert shown['big text']['size'] == pytest.approx(1.5 * shown['text']['size'], rel=0.02)
    assert shown['text']['left'] > 0 and shown['text']['bottom'] > 0


def test_text_is_an_overlay(shown):
    assert shown['hidden'] is True and shown['text while hidden'] == 0


def test_failure_is_told_once(shown):
    assert shown['output'].count('ValueError: broken on purpose') == 1


def test_nothing_stays_behind(shown):
    assert shown['unregistered'] == [True, False, '']


def test_nothing_else_was_raised(shown):
    assert shown['output'].count('Traceback') == 1, shown['output']
