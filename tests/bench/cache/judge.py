# SPDX-License-Identifier: GPL-3.0-or-later
"""How far indirect light is from two references that have noise of their own.

paths, Cycles   RMSE of DiffInd times colour, relative to the reference's mean
both            the same against what both references mean: the mean of the product of the differences to one and to
                the other, in which the references' noise cancels, since each has its own
light           as "both", of DiffInd alone
energy          mean of ours over that of the reference, of DiffInd times colour; "C" of Cycles
flip, lab, seen FLIP, CIE Lab RMSE and the share of pixels that look different, of pictures that are made as bright as
                they are looked at best, against the mean of both references
"""

import metrics
import numpy as np
from figures import BRIGHT

FORMATS = {"paths": ".4f", "Cycles": ".4f", "both": ".4f", "light": ".4f", "energy": ".4f", "energy C": ".4f", "flip": ".4f",
           "lab": ".3f", "seen": ".2%"}


def noiseless(picture, first, second):
    """Relative RMSE of float[H, W, C] against what two independent references have in common."""
    squared = np.mean((picture - first) * (picture - second))
    mean = abs(first.mean() + second.mean()) / 2.0
    return float(np.sqrt(max(squared, 0.0)) / mean) if mean > 0.0 else None


def ratio(picture, reference):
    """Mean over the reference's mean; None where that is black."""
    mean = reference.mean()
    return float(picture.mean() / mean) if mean > 0.0 else None


def exposure(reference):
    """By what pictures are multiplied so that the brightest tenth of the reference begins at BRIGHT."""
    bright = np.quantile(reference, 0.9)
    return BRIGHT / bright if bright > 0.0 else 1.0


def look(picture, reference):
    """Metrics of what is looked at."""
    gain = exposure(reference)
    shown = np.maximum(picture, 0.0) * gain, reference * gain
    return {"flip": metrics.flip(*shown), "lab": metrics.lab_rmse(*shown), "seen": metrics.perceptual_share(*shown)}


def row(light, paths, cycles, colour):
    """One line of the table: DiffInd of ours and of both references, and DiffCol; float64[H, W, 3] each."""
    ours, first, second = light * colour, paths * colour, cycles * colour
    return {"paths": metrics.relative_rmse(ours, first), "Cycles": metrics.relative_rmse(ours, second),
            "both": noiseless(ours, first, second), "light": noiseless(light, paths, cycles),
            "energy": ratio(ours, first), "energy C": ratio(ours, second), **look(ours, (first + second) / 2.0)}


def floor(paths, cycles, colour):
    """The line of the references beside each other: what no picture can be told to be better than."""
    first, second = paths * colour, cycles * colour
    return {"Cycles": metrics.relative_rmse(first, second), "energy C": ratio(first, second), **look(first, second)}
