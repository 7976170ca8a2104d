# SPDX-License-Identifier: GPL-3.0-or-later
"""FLIP for pictures of low dynamic range: how visible a difference is when two pictures are flipped.

After Andersson, Nilsson, Akenine-Moeller, Oskarsson, Aastroem and Fairchild, "FLIP: A Difference Evaluator
for Alternating Images", HPG 2020, written from the paper. Two pipelines meet at the end. The colour
pipeline blurs each opponent channel by what the eye's contrast sensitivity leaves at the viewing
distance and measures the rest by HyAB in a Hunt-adjusted CIE L*a*b*. The feature pipeline compares the
strength of edges and points in the luminance. The result is colour ** (1 - feature), 0..1 per pixel.

Costs about 0.3 s for 480x270: every filter is separable, so each is a loop over some twenty taps.
"""

import math

import numpy as np

# Linear Rec.709 to XYZ; the white point is that of the matrix, so that white has exactly L* = 100.
RGB_TO_XYZ = np.array([[10135552 / 24577794, 8788810 / 24577794, 4435075 / 24577794],
                       [2613072 / 12288897, 8788810 / 12288897, 887015 / 12288897],
                       [1425312 / 73733382, 8788810 / 73733382, 70074185 / 73733382]])
XYZ_TO_RGB = np.linalg.inv(RGB_TO_XYZ)
WHITE = RGB_TO_XYZ.sum(axis=1)

# A screen .7 m away, .7 m wide, with 3840 pixels: the paper's default observer.
PIXELS_PER_DEGREE = 67.0

# Table 1 of the paper: each sensitivity is a sum of Gaussians, (a, b) each, over degrees of visual angle.
SENSITIVITY = {"achromatic": ((1.0, 0.0047),),
               "red-green": ((1.0, 0.0053),),
               "blue-yellow": ((34.1, 0.04), (13.5, 0.025))}
# The widest Gaussian sets the radius of all three, at three standard deviations.
SENSITIVITY_WIDEST = 0.04

COLOUR_EXPONENT = 0.7         # q_c: compresses large colour differences
FEATURE_EXPONENT = 0.5        # q_f
COMPRESSION_START = 0.4       # p_c: the share of the largest difference below which the map is linear
COMPRESSION_VALUE = 0.95      # p_t: the error to which that share is mapped
FEATURE_WIDTH_DEGREES = 0.082  # w: the width of the edges and points that are looked for


def linear_to_opponent(linear):
    """Linear RGB to YCxCz, an L*a*b* without its cube root: linear, so that it may be filtered."""
    x, y, z = np.moveaxis(linear @ RGB_TO_XYZ.T / WHITE, -1, 0)
    return np.stack([116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)], axis=-1)


def opponent_to_linear(opponent):
    """YCxCz back to linear RGB."""
    luminance, red_green, blue_yellow = np.moveaxis(opponent, -1, 0)
    y = (luminance + 16.0) / 116.0
    return np.stack([y + red_green / 500.0, y, y - blue_yellow / 200.0], axis=-1) * WHITE @ XYZ_TO_RGB.T


def linear_to_lab(linear):
    """Linear RGB to CIE L*a*b* with the white point of the RGB space."""
    ratio = linear @ RGB_TO_XYZ.T / WHITE
    delta = 6 / 29
    x, y, z = np.moveaxis(np.where(ratio > delta**3, np.cbrt(ratio), ratio / (3 * delta**2) + 4 / 29), -1, 0)
    return np.stack([116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)], axis=-1)


def hunt_adjusted(lab):
    """Scales chroma by lightness: dark colours look less colourful (the Hunt effect)."""
    return np.concatenate([lab[..., :1], 0.01 * lab[..., :1] * lab[..., 1:]], axis=-1)


def hyab(one, other):
    """HyAB: city-block between lightness and chroma, Euclidean within chroma."""
    difference = one - other
    return np.abs(difference[..., 0]) + np.hypot(difference[..., 1], difference[..., 2])


def largest_colour_difference():
    """The largest colour difference that the screen can show, green against blue, after compression."""
    primaries = hunt_adjusted(linear_to_lab(np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])))
    return float(hyab(primaries[0], primaries[1]) ** COLOUR_EXPONENT)


def convolve(plane, along_x, along_y):
    """Correlates float[H, W] with the outer product of two odd-length filters; edges are repeated."""
    for axis, taps in ((1, along_x), (0, along_y)):
        radius = len(taps) // 2
        padding = [(0, 0), (0, 0)]
        padding[axis] = (radius, radius)
        padded = np.pad(plane, padding, mode="edge")
        length = plane.shape[axis]
        plane = sum(tap * padded.take(range(at, at + length), axis=axis) for at, tap in enumerate(taps))
    return plane


def sensitivity_filtered(opponent, pixels_per_degree):
    """Blurs each opponent channel of float[H, W, 3] by the eye's contrast sensitivity for it."""
    radius = math.ceil(3.0 * math.sqrt(SENSITIVITY_WIDEST / (2.0 * math.pi**2)) * pixels_per_degree)
    squared_degrees = (np.arange(-radius, radius + 1) / pixels_per_degree) ** 2
    channels = []
    for index, terms in enumerate(SENSITIVITY.values()):
        # Each Gaussian is separable, their sum is not: filter by each and add, then normalise the sum.
        filtered, total = 0.0, 0.0
        for a, b in terms:
            taps = np.exp(-math.pi**2 * squared_degrees / b)
            weight = a * math.sqrt(math.pi / b)
            filtered = filtered + weight * convolve(opponent[..., index], taps, taps)
            total += weight * taps.sum() ** 2
        channels.append(filtered / total)
    return np.stack(channels, axis=-1)


def feature_strengths(luminance, pixels_per_degree):
    """The strength of edges and of points in float[H, W] luminance of 0..1; returns the two pictures.

    Edges are the first derivative of a Gaussian, points the second. Their positive weights sum to 1 and
    their negative ones to -1, so that a step, or a line, of full contrast answers with at most 1.
    """
    deviation = 0.5 * FEATURE_WIDTH_DEGREES * pixels_per_degree
    x = np.arange(-math.ceil(3.0 * deviation), math.ceil(3.0 * deviation) + 1)
    bell = np.exp(-(x**2) / (2.0 * deviation**2))
    smooth = bell / bell.sum()
    strengths = []
    for taps in (-x * bell, (x**2 / deviation**2 - 1.0) * bell):
        taps = np.where(taps > 0.0, taps / taps[taps > 0.0].sum(), -taps / taps[taps < 0.0].sum())
        strengths.append(np.hypot(convolve(luminance, taps, smooth), convolve(luminance, smooth, taps)))
    return strengths


def flip(test, reference, pixels_per_degree=PIXELS_PER_DEGREE):
    """The FLIP error map.

    test, reference: float[H, W, 3] scene-linear Rec.709; clamped to 0..1, as a screen shows them.
    Returns float[H, W] in 0..1. Raises ValueError where the shapes differ.
    """
    if test.shape != reference.shape:
        raise ValueError(f"The pictures differ in size: {test.shape} and {reference.shape}.")
    opponents = [linear_to_opponent(np.clip(np.asarray(picture, np.float64), 0.0, 1.0))
                 for picture in (test, reference)]

    # Colour: what remains visible, as a difference, mapped to 0..1 with the large ones compressed.
    seen = [hunt_adjusted(linear_to_lab(np.clip(
        opponent_to_linear(sensitivity_filtered(opponent, pixels_per_degree)), 0.0, 1.0))) for opponent in opponents]
    difference = hyab(*seen) ** COLOUR_EXPONENT
    largest = largest_colour_difference()
    start = COMPRESSION_START * largest
    colour = np.where(difference < start, COMPRESSION_VALUE / start * difference,
                      COMPRESSION_VALUE + (difference - start) / (largest - start) * (1.0 - COMPRESSION_VALUE))

    # Features: the larger of the changes of edge and point strength.
    (edges, points), (reference_edges, reference_points) = (
        feature_strengths((opponent[..., 0] + 16.0) / 116.0, pixels_per_degree) for opponent in opponents)
    change = np.maximum(np.abs(edges - reference_edges), np.abs(points - reference_points))
    feature = np.minimum(change / math.sqrt(2.0), 1.0) ** FEATURE_EXPONENT
    return colour ** (1.0 - feature)
