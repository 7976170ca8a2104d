# SPDX-License-Identifier: GPL-3.0-or-later
"""A 3D View's statistics in words."""

import pytest

from panoptes import statistics_text


def effect(name, ms=None, reason='asked for'):
    return {'name': name, 'runs': ms is not None, 'reason': reason, 'ms': ms or 0.0}


def stats(effects=(), passes=(), samples=4, error=None):
    return {'samples': samples, 'effects': list(effects), 'estimated_error': error,
            'passes': [{'name': name, 'ms': ms} for name, ms in passes]}


def lines(found, method='realtime', samples=4, wanted=16, **more):
    return statistics_text.lines(found, method, samples, wanted, **more)


class TestProgress:
    """The first line."""

    def test_method_and_samples(self):
        assert lines({}) == ['Real-time, sample 4 of 16']
        assert lines({}, 'primitive', 16) == ['Paths, 16 samples']

    def test_coarseness(self):
        assert lines({}, coarseness=3) == ['Real-time, sample 4 of 16, 1/3 of the resolution']

    @pytest.mark.parametrize(('seconds', 'text'), [(None, ''), (0.4, ''), (75.0, ', 1:15 left')])
    def test_time_left(self, seconds, text):
        assert lines({}, seconds_left=seconds) == ['Real-time, sample 4 of 16' + text]


class TestError:
    """The second line."""

    @pytest.mark.parametrize(('error', 'text'), [(None, '—'), (0.0, '0 %'), (0.01234, '1.23 %'),
                                                 (2.5, '250 %')])
    def test_error(self, error, text):
        assert lines(stats(error=error))[1] == f'Estimated error {text}'

    def test_nothing_is_told_before_a_sample_is_there(self):
        assert lines(stats([effect('surfaces', 5.0)], samples=0)) == ['Real-time, sample 4 of 16']


class TestTimes:
    """What takes how long."""

    def test_longest_come_first_and_the_rest_is_summed(self):
        effects = [effect(name, ms) for name, ms in
                   (('a', 4.0), ('b_shadows', 40.0), ('c', 8.0), ('d', 20.0), ('e', 12.0), ('f', 0.0))]
        passes = [('a', 4.0), ('b_shadows', 40.0), ('c', 8.0), ('d', 20.0), ('e', 12.0), ('compose', 6.0)]
        assert lines(stats(effects, passes))[2] == (
            'A sample: b shadows 10.0 ms, d 5.0 ms, e 3.0 ms, c 2.0 ms, the rest 2.5 ms')

    def test_what_serves_several_effects_is_named(self):
        found = stats([effect('a', 4.0), effect('b', 2.0)], [('a_draw', 4.0), ('b', 2.0), ('structure', 40.0)])
        assert lines(found)[2] == 'A sample: structure 10.0 ms, a 1.0 ms, b 0.5 ms'

    def test_no_rest(self):
        assert lines(stats([effect('a', 4.0)], [('a', 4.0)]))[2] == 'A sample: a 1.0 ms'

    def test_times_that_are_no_numbers_are_left_out(self):
        # The native engine writes null for what is not finite.
        found = stats([{'name': 'a', 'runs': True, 'reason': '', 'ms': None}], [('a', None)])
        assert lines(found) == ['Real-time, sample 4 of 16', 'Estimated error —']


class TestSkipped:
    """What does not run, and why."""

    def test_reasons(self):
        found = stats([effect('layers', reason='no coat'), effect('world_light', reason='the world is black'),
                       effect('world_background', reason='the world is black'), effect('surfaces', 1.0),
                       effect('pass_depth', reason='not enabled in the view layer')])
        assert lines(found)[-1] == (
            'Skipped: world light, world background (the world is black), layers (no coat)')

    def test_one_line_tells_how_many_more(self):
        found = stats([effect(f'effect_{i}', reason=f'reason number {i} of many') for i in range(30)])
        text = lines(found)[-1]
        named = text.count('(')
        assert len(text) <= 150 and 2 < named < 30 and text.endswith(f' and {30 - named} more')

    def test_narrow_views_get_fewer(self):
        found = stats([effect(f'effect_{i}', reason=f'reason number {i} of many') for i in range(30)])
        assert lines(found, letters=90)[-1].count('(') < lines(found)[-1].count('(')
        # Something is said in the narrowest.
        assert lines(found, letters=0)[-1] == 'Skipped: effect 0 (reason number 0 of many) and 29 more'

    def test_what_artists_look_for_comes_first(self):
        found = stats([effect('layers', reason='no coat'), effect('radiance_cache', reason='switched off')])
        assert lines(found)[-1] == 'Skipped: radiance cache (switched off), layers (no coat)'

    def test_one_reason_does_not_fill_the_line(self):
        found = stats([effect(f'effect_{i}', reason='the same') for i in range(9)])
        assert lines(found)[-1] == 'Skipped: effect 0, effect 1, effect 2 (the same) and 6 more'

    def test_nothing_skipped(self):
        assert len(lines(stats([effect('a', 4.0)], [('a', 4.0)]))) == 3
