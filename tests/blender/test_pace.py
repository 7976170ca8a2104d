# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures get coarser while the view moves and they take too long, and full again at rest."""

from panoptes.pace import COARSEST, REST, Pace

BUDGET = 0.1


def moving(seconds, steps=2, budget=BUDGET):
    """Return a pace after changes that follow each other, where full pictures take so many seconds."""
    pace = Pace()
    for step in range(steps):
        pace.changed(budget, now=0.1 * step)
        pace.took(seconds / pace.coarseness ** 2, pace.coarseness)
    return pace


def test_a_single_edit_is_answered_at_full_resolution():
    pace = Pace()
    pace.took(5.0, 1)
    pace.changed(BUDGET, now=0.0)
    assert pace.coarseness == 1
    pace.changed(BUDGET, now=2.0 * REST)
    assert pace.coarseness == 1


def test_pictures_that_fit_stay_full():
    assert moving(0.05).coarseness == 1


def test_slow_ones_get_as_coarse_as_it_takes():
    assert moving(0.15).coarseness == 2
    assert moving(0.35).coarseness == 2
    assert moving(0.85).coarseness == 3
    assert moving(100.0).coarseness == COARSEST


def test_no_budget_means_full_resolution():
    assert moving(100.0, budget=0.0).coarseness == 1


def test_stays_while_moving_and_comes_back_at_rest():
    pace = moving(0.35, steps=10)
    assert pace.coarseness == 2 and not pace.rests(now=0.9 + 0.5 * REST)
    assert pace.rests(now=0.9 + 1.5 * REST)
    pace.changed(BUDGET, now=10.0)
    assert pace.coarseness == 1


def test_what_takes_long_at_any_size_does_not_make_pictures_ever_coarser():
    # A third of the time is not the pixels'.
    pace = Pace()
    for step in range(10):
        pace.changed(BUDGET, now=0.1 * step)
        pace.took(0.05 + 0.1 / pace.coarseness ** 2, pace.coarseness)
        assert pace.coarseness <= 2
