# SPDX-License-Identifier: GPL-3.0-or-later
"""What views cost: the sections init, phantoms and cost.

Times are those of the occlusion's own passes, the drawing of phantom views among them, per sample of the film. What is
compared is rendered by turns in one process, several times; the median counts, and the first round, which compiles, does
not.
"""

import numpy as np
import stage
import tables
import variants
from error import reduced, rmse
from shots import Shots
from stage import our_scene

LADDER = (1, 2, 3, 4, 5, 7, 9, 11, 13, 15)
RESOLUTIONS = (64, 128, 256, 512, 1024)
VIEWS = (1, 2, 3)
OCCLUSION, DRAWING = ("ambient_occlusion", "occlusion_"), ("occlusion_phantom_views_draw",)


def by_turns(shots, options, distance, named):
    """{name: (the last Shot, median ms of the occlusion, median ms of drawing phantom views)} of named settings."""
    taken = stage.by_turns(named, lambda settings: shots.estimate(options.samples, distance, **settings), options.repeat)
    return {name: (runs[-1], *(stage.median_milliseconds(runs, *which) / options.samples for which in (OCCLUSION, DRAWING)))
            for name, runs in taken.items()}


# --- init -----------------------------------------------------------------------------------------------------


def init(options):
    """Figure 4.8: what dealing out the rest of the samples by the first of them changes."""
    shots = Shots(options.scene or our_scene("colonnade"), options.pixels)
    distance = options.distance or shots.default_distance()
    seen, _ = shots.surfaces()
    found = {"scene": shots.path.stem, "distance": distance, "estimators": {}}
    for estimator in (name for name in options.estimators if name != "hbao"):
        settings = variants.variants(estimator)
        named = {"none dealt": settings[variants.LAMPS], variants.SINGLE: settings[variants.SINGLE],
                 **{f"first {first}": {**settings[variants.LAMPS_IS], "initial_samples": first} for first in LADDER}}
        taken = by_turns(shots, options, distance, named)
        plain, plain_ms, _ = taken["none dealt"]
        rows = {name: {"difference": rmse(shot.occlusion - plain.occlusion, seen), "ms": ms, "time": ms / plain_ms if plain_ms else None}
                for name, (shot, ms, _) in taken.items()}
        found["estimators"][estimator] = rows
        tables.show(f"init: {estimator} on {shots.path.stem}, {options.size}, {options.samples} samples of the film; RMS difference to "
                    "lamps' maps without importance sampling, time as a share of its time", rows,
                    {"difference": ".4f", "ms": ".1f", "time": ".2f"})
    return found


# --- phantoms -------------------------------------------------------------------------------------------------


def phantoms(options):
    """Figure 4.12: how fine the phantom views have to be."""
    shots = Shots(options.scene or our_scene("confined"), options.pixels)
    distance = options.distance or shots.default_distance()
    seen, _ = shots.surfaces()
    truth = shots.trace(options.reference_samples, distance)
    estimator = options.estimators[0]
    settings = variants.variants(estimator)
    named = {variants.SINGLE: settings[variants.SINGLE],
             **{f"{side} texels": {**settings[variants.PHANTOMS_IS], "phantom_resolution": side} for side in RESOLUTIONS}}
    taken = by_turns(shots, options, distance, named)
    single, single_ms, _ = taken[variants.SINGLE]
    base = rmse(single.occlusion - truth, seen)
    rows = {}
    for name, (shot, ms, drawing) in taken.items():
        error = rmse(shot.occlusion - truth, seen)
        rows[name] = {"rmse": error, "less by": reduced(error, base), "draw ms": drawing, "all ms": ms,
                      "time": ms / single_ms if single_ms else None}
        tables.write(options.pictures, f"phantoms_{name.split()[0]}", [truth, shot.occlusion])
    tables.show(f"phantoms: {estimator} on {shots.path.stem}, {options.size}, {options.samples} samples of the film, range "
                f"{distance:.2f} m; time as a share of the single view's", rows,
                {"rmse": ".4f", "less by": ".1%", "draw ms": ".2f", "all ms": ".1f", "time": ".2f"})
    return {"scene": shots.path.stem, "distance": distance, "rows": rows}


# --- cost -----------------------------------------------------------------------------------------------------


def views_of(estimator):
    """{name: settings} of Figure 4.7's bars: so many views with and without importance sampling, and the phantom pair."""
    settings = variants.variants(estimator)
    named = {variants.SINGLE: settings[variants.SINGLE]}
    for views in VIEWS[1:]:
        named[f"{views} views"] = {**settings[variants.LAMPS], "secondary_views": views - 1}
        if variants.LAMPS_IS in settings:
            named[f"{views} views + IS"] = {**settings[variants.LAMPS_IS], "secondary_views": views - 1}
    named["phantom pair + IS"] = {**settings[variants.PHANTOMS_IS], "secondary_views": 0}
    return named


def cost(options):
    """Figure 4.7: time of views beside the samples that they take."""
    shots = Shots(options.scene or our_scene("colonnade"), options.pixels)
    distance = options.distance or shots.default_distance()
    turn = 0.7
    while shots.lamp_count() < VIEWS[-1] - 1:
        shots.add_sun(turn)
        turn += 2.0
    found = {"scene": shots.path.stem, "distance": distance, "estimators": {}}
    for estimator in options.estimators:
        named = views_of(estimator)
        taken = by_turns(shots, options, distance, named)
        samples = {name: shots.samples_taken(distance, **settings) for name, settings in named.items()}
        _, single_ms, _ = taken[variants.SINGLE]
        rows = {name: {"ms": ms, "draw ms": drawing, "samples": samples[name], "time": ms / single_ms,
                       "samples ratio": samples[name] / samples[variants.SINGLE],
                       "time/samples": ms / single_ms / (samples[name] / samples[variants.SINGLE])}
                for name, (_, ms, drawing) in taken.items()}
        found["estimators"][estimator] = rows
        tables.show(f"cost: {estimator} on {shots.path.stem}, {options.size}, {options.samples} samples of the film, median of "
                    f"{options.repeat} by turns; time and samples as shares of the single view's", rows,
                    {"ms": ".1f", "draw ms": ".2f", "samples": ".2f", "time": ".2f", "samples ratio": ".2f", "time/samples": ".2f"})
    return found
