# SPDX-License-Identifier: GPL-3.0-or-later
"""What each setting of the cache is worth: the section ladders, error and time from few to many.

One setting changes at a time, all others are as they are by themselves but for those that a ladder names: what
reflective shadow maps do shows in their own way to find the first bounce.

The stride of pixels that tell which cells are seen does nothing in small pictures, where the engine looks at no fewer
than 60 rows. So its pictures are larger, with references of as many paths in all: their noise counts for nothing in
"both" and "light", but is in the other columns.
"""

from typing import NamedTuple

import judge
import light
import numpy as np
import stage
import tables

BOUNCES = 2
SCENES = ("sponza_crytek", "canyon", "doorway")


class Ladder(NamedTuple):
    """Values of one setting, with others that they need, and by how much larger the pictures' sides are."""
    setting: str
    values: tuple
    others: dict = {}
    larger: int = 1


DIRECTIONS = (8, 16, 32, 64, 128, 256)
RSM = {"first_bounce": "rsm", "bounces": 1}
LADDERS = {
    "resolution": Ladder("resolution", (8, 16, 24, 32, 48)),
    "rsm samples": Ladder("rsm_samples", (25, 50, 100, 200, 400, 800), RSM),
    "rsm spread s, window alone": Ladder("rsm_spread", (0.1, 0.2, 0.4, 0.8, 1.0), {**RSM, "rsm_mixed": False}),
    "rsm spread s, mixed": Ladder("rsm_spread", (0.1, 0.2, 0.4, 0.8, 1.0), {**RSM, "rsm_mixed": True}),
    "directions": Ladder("directions", DIRECTIONS),
    # The first bounce has samples of its own, as in the dissertation, so that these are its n_sec.
    "directions of later bounces": Ladder("directions", DIRECTIONS, {**RSM, "bounces": BOUNCES}),
    # 0: every voxel that a ray passes.
    "march steps": Ladder("march_steps", (4, 6, 8, 12, 24, 48, 0)),
    "voxel fill": Ladder("voxel_fill", (0.0, 0.25, 0.5, 0.75, 1.0)),
    "depth stride": Ladder("depth_stride", (1, 2, 4, 8), {"occupancy": "depth", "bounces": 1}, larger=4),
}


def climb(scene, ladder, options):
    """One ladder: {value: row}."""
    colour = scene.colour()
    settings = {str(value): {"bounces": BOUNCES, **ladder.others, ladder.setting: value} for value in ladder.values}
    bounces = ladder.others.get("bounces", BOUNCES)
    samples = max(options.reference_samples // ladder.larger**2, 1)
    paths, cycles = (trace(samples, bounces) for trace in (scene.paths, scene.cycles))
    taken = stage.by_turns(settings, lambda chosen: scene.cached(options.samples, **chosen), options.repeat)
    return {name: {**judge.row(shots[-1].passes["DiffInd"][:, :, :3].astype(np.float64), paths, cycles, colour),
                   "voxels ms": stage.median_milliseconds(shots, *light.VOXELS), "cache ms": light.cache_milliseconds(shots)}
            for name, shots in taken.items()}


def run(options):
    """Measures and prints; returns what was found."""
    found = {}
    for path in light.paths_of(options, SCENES):
        of_scene = found.setdefault(path.stem, {})
        for name in options.ladders or LADDERS:
            scene = light.Light(path, [side * LADDERS[name].larger for side in options.pixels])
            of_scene[name] = climb(scene, LADDERS[name], options)
            tables.show(f"ladders: {name} on {path.stem}, {scene.size[0]}x{scene.size[1]}, {options.samples} samples of the film",
                        of_scene[name], {**judge.FORMATS, "voxels ms": ".1f", "cache ms": ".1f"})
    return found
