# SPDX-License-Identifier: GPL-3.0-or-later
"""The share of pixels that look different: its parts against their formulas, and edits that are seen or are not."""

import numpy as np
import pytest

import metrics
import perceptual

SIZE = (90, 160)


def grey(value):
    return np.full((*SIZE, 3), value)


def checkers(low, high, side):
    """A chessboard whose squares have `side` pixels."""
    y, x = np.mgrid[:SIZE[0], :SIZE[1]] // side
    return np.repeat(np.where((x + y) % 2, high, low)[:, :, None], 3, axis=2)


def test_thresholds_rise_with_luminance_and_have_no_jumps():
    # 100 cd/m^2: 10^(2 - 1.255); in the dark the least that there is.
    assert perceptual.threshold(np.array(100.0)) == pytest.approx(5.559, abs=1e-3)
    assert perceptual.threshold(np.array(1e-5)) == pytest.approx(10**-2.86)
    found = perceptual.threshold(10.0 ** np.linspace(-5.0, 3.0, 4001))
    # The formulas' rounded coefficients leave steps of 3 % where the pieces meet.
    assert (np.abs(np.diff(found)) < 0.03 * found[:-1]).all() and found[-1] == found.max()


def test_the_eye_is_most_sensitive_to_its_best_frequency():
    frequencies = np.linspace(0.2, 30.0, 3000)
    found = perceptual.contrast_sensitivity(frequencies, perceptual.WEIGHING_LUMINANCE)
    assert frequencies[found.argmax()] == pytest.approx(perceptual.BEST_FREQUENCY, abs=0.05)
    assert (perceptual.contrast_sensitivity(frequencies, 1.0) < found).all()


def test_contrast_masks():
    found = perceptual.masking(np.linspace(0.0, 50.0, 100))
    assert found[0] == 1.0 and (np.diff(found) > 0.0).all()


def test_levels_are_octaves_that_keep_the_mean_of_what_is_even():
    levels = perceptual.pyramid(grey(7.0)[..., 0])
    assert len(levels) == perceptual.BANDS + 2
    assert all(level == pytest.approx(7.0) for level in levels)
    # A wave of 2 pixels is gone in the first level, one of 32 is all but there in the second.
    for length, level, least, most in ((2, 1, 0.0, 0.01), (32, 2, 0.85, 1.0)):
        wave = np.tile(np.cos(2.0 * np.pi * np.arange(160) / length), (8, 1))
        assert least <= np.abs(perceptual.pyramid(wave)[level][:, 40:120]).max() <= most


def test_identical_pictures_look_alike():
    noise = np.random.default_rng(1).random((*SIZE, 3))
    assert metrics.perceptual_share(noise, noise.copy()) == 0.0


def test_noise_below_the_threshold_is_not_seen():
    # On 50 cd/m^2 the threshold is 3.1 cd/m^2.
    noise = np.random.default_rng(2).uniform(-1.0, 1.0, SIZE)[:, :, None]
    assert metrics.perceptual_share(grey(0.5) + 0.014 * noise, grey(0.5)) == 0.0


@pytest.mark.parametrize("edit", [(0.9, 0.9, 0.9), (0.3, 0.05, 0.05)])
def test_an_edit_is_seen_where_it_is(edit):
    test = grey(0.1)
    test[20:50, 30:110] = edit
    assert metrics.perceptual_share(test, grey(0.1)) == 30 * 80 / (90 * 160)
    mask = np.zeros(SIZE, bool)
    mask[:, 30:110] = True
    assert metrics.perceptual_share(test, grey(0.1), mask) == 30 / 90


def test_texture_hides_what_is_seen_on_an_even_ground():
    assert metrics.perceptual_share(grey(0.54), grey(0.5)) == 1.0
    ground = checkers(0.2, 0.8, 2)
    assert metrics.perceptual_share(ground + 0.04, ground) < 0.05


def test_colour_is_hardly_seen_in_the_dark():
    bright, dark = np.array((0.55, 0.5, 0.5)), np.array((0.00055, 0.0005, 0.0005))
    assert metrics.perceptual_share(grey(1.0) * bright, grey(0.5)) == 1.0
    assert metrics.perceptual_share(grey(1.0) * dark, grey(0.0005)) == 0.0


def test_other_sizes_are_refused():
    with pytest.raises(ValueError, match="differ in size"):
        perceptual.seen(grey(0.5), grey(0.5)[1:])
