# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a picture is from its reference: the numbers that every comparison of this project uses.

All functions take float[H, W, C] scene-linear Rec.709 and an optional mask bool[H, W] of the pixels that
count. A pixel that is not finite is an error of the renderer and raises ValueError, in the test picture
and in the reference alike: it would otherwise vanish in a mean or poison it.
"""

import numpy as np

import flip as flip_metric
import images
import perceptual

# Keeps the relative MSE finite where the reference is black: a tenth of mid-grey, squared. Darker
# pixels than that are weighed by their absolute error.
RELATIVE_MSE_EPSILON = 0.01


def checked(test, reference, mask=None):
    """The pixels that count, as two float64[N, C]; raises ValueError for pictures that cannot be compared."""
    test, reference = np.asarray(test, np.float64), np.asarray(reference, np.float64)
    if test.shape != reference.shape or test.ndim != 3:
        raise ValueError(f"The pictures differ in size: {test.shape} and {reference.shape}; render both alike.")
    for name, picture in (("test picture", test), ("reference", reference)):
        bad = np.count_nonzero(~np.isfinite(picture).all(axis=2))
        if bad:
            raise ValueError(f"{bad} pixels of the {name} are NaN or infinite; no error can be measured.")
    if mask is None:
        mask = np.ones(test.shape[:2], bool)
    if mask.shape != test.shape[:2]:
        raise ValueError(f"The mask's size {mask.shape} is not the pictures' {test.shape[:2]}.")
    if not mask.any():
        raise ValueError("The mask keeps no pixel; there is nothing to compare.")
    return test[mask], reference[mask]


def rmse(test, reference, mask=None):
    """Root of the mean squared error, linear."""
    test, reference = checked(test, reference, mask)
    return float(np.sqrt(np.mean((test - reference) ** 2)))


def relative_rmse(test, reference, mask=None):
    """RMSE divided by the reference's mean; 0 for two black pictures, infinite for a black reference only."""
    test, reference = checked(test, reference, mask)
    error, mean = np.sqrt(np.mean((test - reference) ** 2)), np.abs(reference.mean())
    return 0.0 if error == 0.0 else float(error / mean) if mean > 0.0 else float("inf")


def srgb_rmse(test, reference, mask=None):
    """RMSE after clamping to 0..1 and the sRGB curve: the error on a screen."""
    test, reference = checked(test, reference, mask)
    return float(np.sqrt(np.mean((images.linear_to_srgb(test) - images.linear_to_srgb(reference)) ** 2)))


def relative_mse(test, reference, mask=None, epsilon=RELATIVE_MSE_EPSILON):
    """Mean of (test - reference)^2 / (reference^2 + epsilon): dark regions weigh as much as bright ones."""
    test, reference = checked(test, reference, mask)
    return float(np.mean((test - reference) ** 2 / (reference**2 + epsilon)))


def lab_rmse(test, reference, mask=None):
    """Root of the mean squared CIE 1976 colour difference, of colours clamped to 0..1; 100 = black to white."""
    test, reference = checked(test, reference, mask)
    difference = (flip_metric.linear_to_lab(np.clip(test, 0.0, 1.0))
                  - flip_metric.linear_to_lab(np.clip(reference, 0.0, 1.0)))
    return float(np.sqrt(np.mean((difference**2).sum(axis=-1))))


def flip(test, reference, mask=None):
    """Mean FLIP over the pixels that count, 0..1; filtered over the whole picture, then masked."""
    checked(test, reference, mask)
    errors = flip_metric.flip(np.asarray(test), np.asarray(reference))
    return float(errors.mean() if mask is None else errors[mask].mean())


def perceptual_share(test, reference, mask=None):
    """Share of the pixels that count which look different to an observer after Yee and Newman, 0..1."""
    checked(test, reference, mask)
    different = perceptual.seen(np.asarray(test), np.asarray(reference))
    return float(different.mean() if mask is None else different[mask].mean())


def all_metrics(test, reference, mask=None):
    """Every metric by name, for float[H, W, 3]; those of colours are left out for what is none (C != 3)."""
    chosen = [relative_rmse, rmse, srgb_rmse, relative_mse]
    if np.shape(test)[-1] == 3:
        chosen += [lab_rmse, flip, perceptual_share]
    return {metric.__name__: metric(test, reference, mask) for metric in chosen}
