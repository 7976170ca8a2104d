#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Traced paths against Cycles' finished pictures of the shared scenes: noise must vanish, and nothing be left.

    tests/scenes/reference_fit.py [SCENE ...] [--most 256] [--pass NAME ...] [--method primitive] [--pictures FOLDER] [--json]

Each scene is rendered with 1, 2, 4, ... samples, each time by another seed. An unbiased picture's squared error against
a reference with noise of its own is RMSE^2 = a / N + b^2, where b is that noise: so much is left of the error with
endless samples. The fit of a and b weighs all N alike, by their relative errors. Printed are, of each pass: its mean
over the reference's (of all samples together) with its standard error, the RMSE at each N, b, and for Combined the
noise of the reference to compare b with. Low-discrepancy samples may beat 1 / N; then b^2 comes out below nothing and
is shown as 0.
"""

import argparse
import json
import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np

import renders

import compare  # noqa: E402  (found through renders, which puts the metrics on the path)
import images  # noqa: E402
import metrics  # noqa: E402

# The noise that is left in each reference, as linear RMSE of Combined: measured when they were made, and said so in
# the README beside them. That of veach_mis is of its mirror plates.
REFERENCE_NOISE = {"cornell": 0.0016, "veach_mis": 0.025, "sponza_crytek": 0.0045, "materialball_glass": 0.018,
                   "foliage_ivy_oak": 0.0063, "igea_deform": 0.0022, "fox_skinned": 0.0013}
# Pixels (rows, columns) of references that are wrong: 5 mm above its lamp cornell's ceiling has a face twice, which in
# Cycles shadows itself. Without the second face Cycles is seven times as bright there.
WRONG = {"cornell": (slice(30, 38), slice(98, 178))}
PASSES = ("Combined", "DiffCol", "DiffDir", "DiffInd", "GlossDir", "GlossInd", "TransDir", "TransInd", "Emit", "Env",
          "AO", "Normal")
# A pass whose mean is below this shows nothing.
DARK = 1e-6


class Fit(NamedTuple):
    """RMSE^2 = a / N + b^2; b is 0 where the errors fall faster."""

    a: float
    b: float


class Pass(NamedTuple):
    """One pass of a scene: mean over the reference's and its standard error, RMSE of each count, and their fit."""

    ratio: float
    ratio_error: float
    rmse: tuple
    fit: Fit


class Agreement(NamedTuple):
    """Two pictures of other seeds, together, against a reference.

    noise: of their mean, RMSE. bias_squared: what of the squared error is neither their noise nor the reference's,
    with its standard error; it may come out below 0. ratio: their mean over the reference's, with its standard error.
    """

    noise: float
    bias_squared: float
    bias_squared_error: float
    ratio: float
    ratio_error: float


def reference_passes(name):
    """Cycles' finished picture of a shared scene, {pass: float32[H, W, C]}."""
    return images.read_passes(renders.SHARED / "reference" / f"{name}.exr")


def render(name, counts, method, reference):
    """Pictures of a shared scene with these numbers of samples, by seeds of their own, as large as its reference.

    Where the reference is wrong, its own pixels take the place of ours.
    """
    height, width = reference["Combined"].shape[:2]
    wanted = [renders.picture("PANOPTES", count, seed=seed, method=method) for seed, count in enumerate(counts, 1)]
    found, _ = renders.render(name, wanted, size=(width, height))
    for picture in found if name in WRONG else ():
        for key in picture.keys() & reference.keys():
            channels = min(picture[key].shape[2], reference[key].shape[2])
            picture[key][(*WRONG[name], slice(channels))] = reference[key][(*WRONG[name], slice(channels))]
    return found


def fit(counts, errors):
    """The Fit of RMSEs at these numbers of samples, by least squares of the relative errors of RMSE^2."""
    squares = np.square(np.asarray(errors, np.float64))
    if not squares.all():
        return Fit(0.0, 0.0)
    unknowns = np.stack([1.0 / np.asarray(counts, np.float64), np.ones(len(counts))], axis=1)
    a, rest = np.linalg.lstsq(unknowns / squares[:, None], np.ones(len(counts)), rcond=None)[0]
    return Fit(float(a), float(np.sqrt(max(rest, 0.0))))


def mean_ratio(counts, pictures, reference):
    """Mean of all samples of `pictures` over the reference's, and its standard error."""
    counts = np.asarray(counts, np.float64)
    means = np.array([picture.mean(dtype=np.float64) for picture in pictures])
    mean = np.average(means, weights=counts)
    spread = (np.sum(counts * (means - mean) ** 2) / (len(counts) - 1)) if len(counts) > 1 else float("nan")
    scale = reference.mean(dtype=np.float64)
    return float(mean / scale), float(np.sqrt(spread / counts.sum()) / scale)


def judge_pass(counts, pictures, reference):
    """The Pass of float[H, W, 3] pictures with these numbers of samples."""
    errors = tuple(metrics.rmse(picture, reference) for picture in pictures)
    return Pass(*mean_ratio(counts, pictures, reference), errors, fit(counts, errors))


def judge(name, counts, method="primitive", names=PASSES, pictures=None):
    """Renders one scene; returns {pass: Pass} of what the reference has and shows."""
    reference = reference_passes(name)
    found = render(name, counts, method, reference)
    if pictures:
        Path(pictures).mkdir(parents=True, exist_ok=True)
        mean = np.average([entry["Combined"][..., :3] for entry in found], axis=0, weights=counts)
        images.write_png(Path(pictures) / f"{name}.png", compare.difference_picture(
            mean, reference["Combined"][..., :3], 4.0))
    return {key: judge_pass(counts, [entry[key][..., :3] for entry in found], reference[key][..., :3])
            for key in names if key in found[0] and key in reference
            and np.abs(reference[key][..., :3]).mean() > DARK}


def blocks(picture, side):
    """Means of blocks of side x side pixels, float64[H // side, W // side, 3]; what is left over at the edges is cut."""
    height, width = (length // side for length in picture.shape[:2])
    cut = picture[:height * side, :width * side, :3].astype(np.float64)
    return cut.reshape(height, side, width, side, 3).mean(axis=(1, 3))


def agreement(one, another, reference, reference_noise, side):
    """The Agreement of two pictures, float[H, W, C], with a reference, by means of blocks of side x side pixels.

    Blocks of many pixels make little of noise, so that a few samples are enough to see what is wrong.
    """
    one, another, reference = (blocks(picture, side) for picture in (one, another, reference))
    mean, half = (one + another) / 2.0, (one - another) / 2.0
    excess = ((mean - reference) ** 2 - half**2).mean(axis=2)
    count = excess.size
    scale = reference.mean()
    return Agreement(
        noise=float(np.sqrt((half**2).mean())),
        bias_squared=float(excess.mean() - (reference_noise / side) ** 2),
        bias_squared_error=float(excess.std() / np.sqrt(count)),
        ratio=float(mean.mean() / scale),
        # Half the difference of two seeds is as noisy as their mean.
        ratio_error=float(np.sqrt((half.mean(axis=2) ** 2).mean() / count) / scale))


def show(name, counts, found):
    """Prints the table of one scene."""
    print(f"{name}, noise of its reference {REFERENCE_NOISE[name]}")
    print(f"{'pass':10}{'mean':>9}{'+-':>8}" + "".join(f"{f'N={count}':>9}" for count in counts) + f"{'b':>9}")
    for key, row in found.items():
        # Directions cancel each other, so their mean says nothing.
        ratio = f"{'-':>9}{'-':>8}" if key == "Normal" else f"{row.ratio:9.4f}{row.ratio_error:8.4f}"
        print(f"{key:10}{ratio}" + "".join(f"{error:9.4f}" for error in row.rmse) + f"{row.fit.b:9.4f}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", nargs="*", default=list(REFERENCE_NOISE), metavar="SCENE")
    parser.add_argument("--most", type=int, default=256, metavar="N", help="samples of the last picture; powers of two go before")
    parser.add_argument("--pass", dest="passes", action="append", choices=PASSES, help="look at these only")
    parser.add_argument("--method", default="primitive", choices=("primitive", "realtime"))
    parser.add_argument("--pictures", metavar="FOLDER", help="write ours, the reference and the difference")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    if not renders.SHARED.is_dir():
        parser.error(f"there are no shared scenes at {renders.SHARED}; name their folder by PANOPTES_SHARED_SCENES.")
    if unknown := set(options.scenes) - set(REFERENCE_NOISE):
        parser.error(f"there is no reference of {', '.join(sorted(unknown))}; there are {', '.join(REFERENCE_NOISE)}.")
    if options.most < 2:
        parser.error("a fit needs two pictures at least; give --most 2 or more.")
    counts = [1 << power for power in range(options.most.bit_length())]
    results = {}
    for name in options.scenes:
        found = judge(name, counts, options.method, options.passes or PASSES, options.pictures)
        if options.json:
            results[name] = {key: {**row._asdict(), "fit": row.fit._asdict()} for key, row in found.items()}
        else:
            show(name, counts, found)
    if options.json:
        print(json.dumps({"counts": counts, "scenes": results}, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main())
