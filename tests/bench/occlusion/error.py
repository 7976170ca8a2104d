# SPDX-License-Identifier: GPL-3.0-or-later
"""How far the occlusion of one view and of several is from that of rays.

Compared is the AO pass without filter, over all surfaces that the camera sees and over those on which a lamp shines:
the region that shadow maps cover. Both references are traced with the same range, by our rays and by Cycles.
"""

import numpy as np
import tables
import variants
from shots import Shots
from stage import our_scene, shared_scene

SCENES = ("sponza_crytek", "igea_deform", "colonnade", "confined")
# The errors' own picture: grey is none, and so often enlarged.
GAIN = 2.0
_FORMATS = {"rmse": ".4f", "less by": ".1%", "bias": "+.4f", "lit rmse": ".4f", "lit less by": ".1%", "lit bias": "+.4f",
            "Cycles rmse": ".4f"}


def scenes(options):
    """Paths of the scenes to measure; a sentence for each that is not there."""
    paths = [options.scene] if options.scene else [
        our_scene(name) if our_scene(name).is_file() else shared_scene(name) for name in SCENES]
    for path in paths:
        if not path.is_file():
            print(f"{path.name} is not beside this checkout; it is left out.\n")
    return [path for path in paths if path.is_file()]


def rmse(difference, mask):
    """Root of the mean square over the pixels of a mask; None where it has none."""
    return float(np.sqrt(np.mean(difference[mask] ** 2))) if mask.any() else None


def mean(difference, mask):
    return float(difference[mask].mean()) if mask.any() else None


def reduced(value, base):
    """The share by which a value is less than another; None where there is none."""
    return None if not base or value is None else 1.0 - value / base


def judge(estimate, truth, cycles, seen, lit):
    """One row of the table."""
    difference = estimate - truth
    return {"rmse": rmse(difference, seen), "bias": mean(difference, seen), "lit rmse": rmse(difference, lit),
            "lit bias": mean(difference, lit), "Cycles rmse": rmse(estimate - cycles, seen)}


def measure(path, options):
    """All estimators on one scene."""
    shots = Shots(path, options.pixels)
    added = shots.lamp_count() == 0
    distance = options.distance or shots.default_distance()
    if added:
        shots.add_sun()
    seen, _ = shots.surfaces()
    truth = shots.trace(options.reference_samples, distance)
    cycles = shots.trace_with_cycles(options.reference_samples, distance)
    rows, taken = {"rays": {"Cycles rmse": rmse(truth - cycles, seen)}}, {}
    for estimator in options.estimators:
        for name, settings in variants.variants(estimator).items():
            taken[estimator, name] = shots.estimate(options.samples, distance, **settings).occlusion
    lit = shots.lit() & seen
    for (estimator, name), occlusion in taken.items():
        row = rows[f"{estimator} {name}"] = judge(occlusion, truth, cycles, seen, lit)
        single = rows[f"{estimator} {variants.SINGLE}"]
        if name != variants.SINGLE:
            row["less by"], row["lit less by"] = (reduced(row[key], single[key]) for key in ("rmse", "lit rmse"))
    for estimator in options.estimators:
        pictures = [occlusion for (owner, _), occlusion in taken.items() if owner == estimator]
        tables.write(options.pictures, f"error_{path.stem}_{estimator}", [truth, *pictures])
        tables.write(options.pictures, f"error_{path.stem}_{estimator}_signed",
                     [0.5 + 0.5 * lit, *(np.where(seen, 0.5 + GAIN * (picture - truth), 0.5) for picture in pictures)])
    return {"scene": path.stem, "distance": distance, "sun_added": added, "surfaces": float(seen.mean()),
            "lit": float(lit.sum() / max(seen.sum(), 1)), "rows": rows}


def run(options):
    """Measures and prints; returns what was found."""
    found = []
    for path in scenes(options):
        scene = measure(path, options)
        found.append(scene)
        sun = "; a sun was added, for the scene has no lamp" if scene["sun_added"] else ""
        tables.show(f"error: {scene['scene']}, {options.size}, {options.samples} samples of the film, range {scene['distance']:.2f} m, "
                    f"surfaces on {scene['surfaces']:.0%} of the picture, of them {scene['lit']:.0%} lit{sun}", scene["rows"], _FORMATS)
    return found
