# SPDX-License-Identifier: GPL-3.0-or-later
"""What the cache costs and what makes it cheaper: the section speed, Table 5.1 and Figures 5.6, 5.11 and 5.12.

Times are those of the cache's own passes, once a picture; what makes voxels is told apart, as in the table, and what
looks cells up for the picture, by which the pass that puts it together takes longer than without a cache. What is
compared is rendered by turns in one process, several times; the median counts, and the first round, which compiles,
does not.
"""

import judge
import light
import metrics
import numpy as np
import stage
import tables

# Of Table 5.1: the scenes that stand for those of the dissertation, with its number of bounces and its resolution.
TABLE = {"canyon": (1, 16), "doorway": (1, 24), "two_spots": (2, 24), "sponza_crytek": (2, 32)}
UNOPTIMISED = "all cells, RGB3"
WITHOUT = "no cache"
# Of Figure 5.11: 11 coefficients, 12 and 12; and what they are measured against, 27.
BALANCED, UNCOMPRESSED = ("y3co1cg1", "y2co2cg2", "rgb2"), "rgb3"
# Of Figure 5.6: so many places along the camera's path.
PLACES = 6
# Of Figure 5.12.
RESOLUTIONS = (16, 24, 32, 48)


def occupied(shot):
    """Share of all cells that hold light."""
    cells = shot.stats["cache"]
    return cells["cells"] / cells["lattice"] if cells["lattice"] else None


def improvement(slow, fast):
    """By how much more a time is than another: t_slow / t_fast - 1."""
    return slow / fast - 1.0 if fast else None


def diffuse(shot):
    """DiffInd, float64[height, width, 3]."""
    return shot.passes["DiffInd"][:, :, :3].astype(np.float64)


def steps(bounces):
    """Settings of the table's steps, each of which adds to the one before.

    Without any optimisation, every cell holds three colours of three bands each. As in the dissertation, cells are those
    that the camera sees where light bounces once, else those of the geometry.
    """
    cells = "depth" if bounces == 1 else "geometry"
    return {UNOPTIMISED: {"occupancy": "all", "encoding": "rgb3"}, "+ occupancy": {"occupancy": cells, "encoding": "rgb3"},
            "+ Y3Co2Cg2": {"occupancy": cells, "encoding": "y3co2cg2"}, "+ Y3Co1Cg1": {"occupancy": cells, "encoding": "y3co1cg1"}}


def table_5_1(options):
    """The steps from every cell to those that count, and from three colours to two bands of chrominance less."""
    found = {}
    for path in light.paths_of(options, TABLE):
        bounces, resolution = TABLE.get(path.stem, (2, 24))
        scene = light.Light(path, options.pixels)
        common = {"bounces": bounces, "resolution": resolution}
        # By turns with the others it would make them find their voxels anew.
        composed = stage.median_milliseconds(stage.by_turns({WITHOUT: {"enabled": False}}, lambda off: scene.cached(1, **off), options.repeat)[WITHOUT],
                                             "compose")
        taken = stage.by_turns(steps(bounces), lambda step: scene.cached(1, **common, **step), options.repeat)
        looked_up = {name: max(stage.median_milliseconds(shots, "compose") - composed, 0.0) for name, shots in taken.items()}
        times = {name: light.cache_milliseconds(shots) + looked_up[name] for name, shots in taken.items()}
        rows, before = {}, None
        for name, shots in taken.items():
            rows[name] = {"voxels ms": stage.median_milliseconds(shots, *light.VOXELS), "GI ms": times[name], "look-ups ms": looked_up[name], "occupancy": occupied(shots[-1]),
                          "gain": None if before is None else improvement(before, times[name]), "total": improvement(times[UNOPTIMISED], times[name])}
            before = times[name]
        colour = scene.colour()
        full, short = (diffuse(scene.cached(options.samples, **common, encoding=encoding)) * colour for encoding in ("y3co3cg3", "y3co1cg1"))
        gain = judge.exposure(full)
        loss = {"lab": metrics.lab_rmse(short * gain, full * gain), "seen": metrics.perceptual_share(short * gain, full * gain)}
        found[path.stem] = {"bounces": bounces, "resolution": resolution, "rows": rows, "y3co3cg3 vs y3co1cg1": loss}
        tables.show(f"Table 5.1: {path.stem}, {bounces} bounces, {resolution} cells along the longest side, {scene.size[0]}x{scene.size[1]}; Y3Co3Cg3 "
                    f"against Y3Co1Cg1: Lab RMSE {loss['lab']:.3f}, {loss['seen']:.2%} of the pixels look different", rows,
                    {"voxels ms": ".2f", "GI ms": ".2f", "look-ups ms": ".2f", "occupancy": ".1%", "gain": "+.1%", "total": "+.1%"})
    return found


def figure_5_6(options):
    """Occupancy by what the camera sees, and its time, along the path of the canyon's camera."""
    scene = light.Light(options.scene or stage.our_scene("canyon"), options.pixels)
    rows = {}
    for frame in np.linspace(scene.scene.frame_start, scene.scene.frame_end, PLACES).round().astype(int):
        scene.scene.frame_set(int(frame))
        taken = stage.by_turns({name: {"occupancy": name, "bounces": 1} for name in ("geometry", "depth")}, lambda chosen: scene.cached(1, **chosen), options.repeat)
        rows[f"frame {frame}"] = {f"{name} {what}": value for name, shots in taken.items()
                                  for what, value in (("occupancy", occupied(shots[-1])), ("ms", light.cache_milliseconds(shots)))}
    tables.show(f"Figure 5.6: along the camera's path through {scene.path.stem}, one bounce, {scene.size[0]}x{scene.size[1]}", rows,
                {"geometry occupancy": ".1%", "geometry ms": ".2f", "depth occupancy": ".1%", "depth ms": ".2f"})
    return {"scene": scene.path.stem, "rows": rows}


def figure_5_11(options):
    """Encodings of about the same size: more bands of luminance, or as many of each."""
    found = {}
    for path in light.paths_of(options, ("two_spots", "canyon", "sponza_crytek")):
        scene = light.Light(path, options.pixels)
        colour = scene.colour()
        whole = diffuse(scene.cached(options.samples, bounces=2, encoding=UNCOMPRESSED)) * colour
        rows = {}
        for encoding in BALANCED:
            shown = diffuse(scene.cached(options.samples, bounces=2, encoding=encoding)) * colour
            rows[encoding] = {"rmse": metrics.relative_rmse(shown, whole), "luminance rmse": metrics.relative_rmse(*(np.repeat(
                picture @ [[0.25], [0.5], [0.25]], 3, axis=2) for picture in (shown, whole))), **judge.look(shown, whole)}
        found[path.stem] = rows
        tables.show(f"Figure 5.11: {path.stem}, against {UNCOMPRESSED} of the same cache", rows,
                    {"rmse": ".4f", "luminance rmse": ".4f", "flip": ".4f", "lab": ".3f", "seen": ".2%"})
    return found


def figure_5_12(options):
    """Time of the cache's stages, summed in their order, against resolution."""
    scene = light.Light(options.scene or stage.our_scene("canyon"), options.pixels)
    taken = stage.by_turns({str(side): {"resolution": side, "bounces": 2} for side in RESOLUTIONS}, lambda chosen: scene.cached(1, **chosen), options.repeat)
    stages = list(dict.fromkeys(name for shots in taken.values() for name in shots[-1].times() if name.startswith(light.CACHE)))
    rows = {}
    for side, shots in taken.items():
        total, row = 0.0, {"occupancy": occupied(shots[-1])}
        for name in stages:
            total += stage.median_milliseconds(shots, name)
            row[name] = total
        rows[side] = row
    tables.show(f"Figure 5.12: cumulative ms of the stages on {scene.path.stem}, two bounces, {scene.size[0]}x{scene.size[1]}", rows,
                {"occupancy": ".1%", **{name: ".2f" for name in stages}})
    return {"scene": scene.path.stem, "rows": rows}


PARTS = {"5.1": table_5_1, "5.6": figure_5_6, "5.11": figure_5_11, "5.12": figure_5_12}


def run(options):
    """Measures and prints; returns what was found."""
    return {name: PARTS[name](options) for name in options.parts or PARTS}
