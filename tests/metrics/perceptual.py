# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a difference between two pictures can be seen at all, after PerceptualDiff.

Yee and Newman, "A Perceptual Metric for Production Testing", Journal of Graphics Tools 9(4), 2004, written from the
formulas. Of each pixel, a difference of luminance is seen when it exceeds

    tvi(adaptation) * elevation

tvi         the threshold against intensity of the adapted eye (Ward Larson et al. 1997), cd/m^2
adaptation  luminance around the pixel, within about one degree
elevation   how far contrast around the pixel raises the threshold: frequencies to which the eye is less sensitive than
            to the best one (Barten's contrast sensitivity, 1989) and masking by what else is there (Daly 1993), of each
            band of a pyramid, weighed by the bands' contrasts; 1 to 10

and one of colour, when the squared distance in a* and b* of CIE L*a*b* exceeds the elevation.

Departures: the pyramid (Burt and Adelson's kernel) is not decimated: every level keeps the picture's size and its
kernel's taps stand apart instead, so that no level is interpolated. How colour fades in the dark is ours: in proportion
to the adaptation below MESOPIC_LIMIT.
"""

import math

import numpy as np

import flip

# The observer: white's luminance in cd/m^2, and how wide a picture is seen, in degrees.
WHITE_LUMINANCE = 100.0
FIELD_OF_VIEW_DEGREES = 45.0
# Below this adaptation, cd/m^2, the eye sees less colour.
MESOPIC_LIMIT = 10.0
MOST_ELEVATION = 10.0
# Bands of an octave each, and the two coarser levels by which the coarsest band's contrast is defined.
BANDS = 6
KERNEL = (0.05, 0.25, 0.4, 0.25, 0.05)
# Where contrast sensitivity is highest at the luminance for which bands are weighed (100 cd/m^2), cycles a degree.
BEST_FREQUENCY, WEIGHING_LUMINANCE = 3.248, 100.0
# Keeps contrasts finite where the picture is black, cd/m^2.
DARKEST = 1e-5


def threshold(luminance):
    """tvi: the least difference of luminance that is seen on a ground of this luminance; both in cd/m^2."""
    log = np.log10(np.maximum(luminance, DARKEST))
    found = np.select(
        [log < -3.94, log < -1.44, log < -0.0184, log < 1.9],
        [np.full_like(log, -2.86), np.maximum(0.405 * log + 1.6, 0.0) ** 2.18 - 2.86, log - 0.395,
         np.maximum(0.249 * log + 0.65, 0.0) ** 2.7 - 0.72], log - 1.255)
    return 10.0**found


def contrast_sensitivity(frequency, luminance):
    """One over the least contrast of a grating that is seen; cycles a degree, cd/m^2."""
    height = 440.0 * (1.0 + 0.7 / luminance) ** -0.2
    fall = 0.3 * (1.0 + 100.0 / luminance) ** 0.15
    return height * frequency * np.exp(-fall * frequency) * np.sqrt(1.0 + 0.06 * np.exp(fall * frequency))


def masking(contrast):
    """By how much a threshold rises over a ground of this contrast, in units of the threshold; at least 1."""
    return (1.0 + (0.0153 * (392.498 * contrast) ** 0.7) ** 4) ** 0.25


def _blurred(picture, distance):
    """float[H, W] blurred along both axes by KERNEL with its taps `distance` apart; the edge's pixels go on outside."""
    for axis in (0, 1):
        places = np.arange(picture.shape[axis])
        picture = sum(weight * np.take(picture, np.clip(places + tap * distance, 0, len(places) - 1), axis)
                      for tap, weight in zip(range(-2, 3), KERNEL))
    return picture


def pyramid(luminance):
    """BANDS + 2 levels of float[H, W], each an octave coarser than the last; the first is the picture."""
    levels = [luminance]
    for level in range(BANDS + 1):
        levels.append(_blurred(levels[-1], 2**level))
    return levels


def seen(test, reference, field_of_view=FIELD_OF_VIEW_DEGREES):
    """Where the pictures look different.

    test, reference: float[H, W, 3] scene-linear Rec.709; clamped to 0..1, as a screen shows them. field_of_view: under
    which the picture's width is seen, degrees. Returns bool[H, W]. Raises ValueError where the shapes differ.
    """
    if test.shape != reference.shape:
        raise ValueError(f"The pictures differ in size: {test.shape} and {reference.shape}.")
    both = [np.clip(np.asarray(picture, np.float64), 0.0, 1.0) for picture in (test, reference)]
    degrees = 2.0 * math.degrees(math.tan(math.radians(field_of_view) / 2.0))
    pixels_per_degree = test.shape[1] / degrees
    levels = [pyramid(WHITE_LUMINANCE * (picture @ flip.RGB_TO_XYZ[1])) for picture in both]

    # The level whose pixels are as wide as a degree, of both pictures.
    adapted_level = min(max(round(math.log2(pixels_per_degree)), 0), BANDS + 1)
    adaptation = np.maximum((levels[0][adapted_level] + levels[1][adapted_level]) / 2.0, DARKEST)

    # Each band counts by its contrast, of whichever picture has more.
    weighed, contrasts = np.zeros(adaptation.shape), np.zeros(adaptation.shape)
    best = contrast_sensitivity(BEST_FREQUENCY, WEIGHING_LUMINANCE)
    for band in range(BANDS):
        frequency = 0.5 * pixels_per_degree / 2**band
        difference = np.maximum(*(np.abs(picture[band] - picture[band + 1]) for picture in levels))
        contrast = difference / np.maximum(np.maximum(*(picture[band + 2] for picture in levels)), DARKEST)
        insensitive = best / contrast_sensitivity(frequency, WEIGHING_LUMINANCE)
        weighed += contrast * insensitive * masking(contrast * contrast_sensitivity(frequency, adaptation))
        contrasts += contrast
    elevation = np.clip(weighed / np.maximum(contrasts, DARKEST), 1.0, MOST_ELEVATION)

    brightness = np.abs(levels[0][0] - levels[1][0]) > elevation * threshold(adaptation)
    labs = [flip.linear_to_lab(picture)[..., 1:] for picture in both]
    colour = ((labs[0] - labs[1]) ** 2).sum(axis=-1) * np.minimum(adaptation / MESOPIC_LIMIT, 1.0) > elevation
    return brightness | colour
