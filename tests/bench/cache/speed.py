# SPDX-License-Identifier: GPL-3.0-or-later
"""What the cache costs and what makes it cheaper: the section speed, Table 5.1 and Figures 5.6, 5.8, 5.11 and 5.12.

Times are those of the cache's own passes, once a picture; what makes voxels is told apart, as in the table, and what
looks cells up for the picture, by which the pass that puts it together takes longer than without a cache. What is
compared is rendered by turns in one process, several times; the median counts, and the first round, which compiles,
does not.
"""

import bpy
import compressed
import judge
import light
import metrics
import numpy as np
import plots
import stage
import tables
from mathutils import Matrix, Vector

# Of Table 5.1: the scenes that stand for those of the dissertation, with its number of bounces and its resolution.
TABLE = {"canyon": (1, 16), "doorway": (1, 24), "two_spots": (2, 24), "sponza_crytek": (2, 32)}
UNOPTIMISED = "all cells, RGB3"
WITHOUT = "no cache"
# Of Figure 5.6: so many places on the way to what is in the middle of the picture, and how much of the way is gone.
PLACES, WAY = 6, 0.9
# Volumes that are chosen by the view would change with it, and with the resolution: here one holds the whole scene.
ONE_VOLUME = {"cascades": 1}
# Of Figure 5.12.
RESOLUTIONS = (16, 24, 32, 48)


def occupied(shot):
    """Share of all cells that hold light."""
    cells = shot.stats["cache"]
    return cells["cells"] / cells["lattice"] if cells["lattice"] else None


def improvement(slow, fast):
    """By how much more a time is than another: t_slow / t_fast - 1."""
    return slow / fast - 1.0 if fast else None


def steps(bounces):
    """Settings of the table's steps, each of which adds to the one before.

    Without any optimisation, every cell holds three colours of three bands each. As in the dissertation, cells are those
    that the camera sees where light bounces once; for more, those of the geometry look around as well, in fewer directions.
    """
    cells = "depth" if bounces == 1 else "tiers"
    return {UNOPTIMISED: {"occupancy": "all", "encoding": "rgb3"}, "+ occupancy": {"occupancy": cells, "encoding": "rgb3"},
            "+ Y3Co2Cg2": {"occupancy": cells, "encoding": "y3co2cg2"}, "+ Y3Co1Cg1": {"occupancy": cells, "encoding": "y3co1cg1"}}


def table_5_1(options):
    """The steps from every cell to those that count, and from three colours to two bands of chrominance less."""
    found = {}
    for path in light.paths_of(options, TABLE):
        bounces, resolution = TABLE.get(path.stem, (2, 24))
        scene = light.Light(path, options.pixels)
        common = {"bounces": bounces, "resolution": resolution, **ONE_VOLUME}
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
        full, short = (scene.diffuse(options.samples, **common, encoding=encoding) * colour for encoding in ("y3co3cg3", "y3co1cg1"))
        gain = judge.exposure(full)
        loss = {"lab": metrics.lab_rmse(short * gain, full * gain), "seen": metrics.perceptual_share(short * gain, full * gain)}
        found[path.stem] = {"bounces": bounces, "resolution": resolution, "rows": rows, "y3co3cg3 vs y3co1cg1": loss}
        tables.show(f"Table 5.1: {path.stem}, {bounces} bounces, {resolution} cells along the longest side, {scene.size[0]}x{scene.size[1]}; Y3Co3Cg3 "
                    f"against Y3Co1Cg1: Lab RMSE {loss['lab']:.3f}, {loss['seen']:.2%} of the pixels look different", rows,
                    {"voxels ms": ".2f", "GI ms": ".2f", "look-ups ms": ".2f", "occupancy": ".1%", "gain": "+.1%", "total": "+.1%"})
    return found


def approach(scene):
    """Moves the scene's camera from place to place; the metres that each lies from the first one.

    The way goes from where the camera begins straight on to what is in the middle of its picture. So nothing stands in
    it, and ever less of the scene is seen, as on the path of the dissertation.
    """
    scene.frame_set(scene.frame_start)
    camera = scene.camera
    start = camera.matrix_world.copy()
    ahead = start.to_quaternion() @ Vector((0.0, 0.0, -1.0))
    hit, place, *_ = scene.ray_cast(bpy.context.evaluated_depsgraph_get(), start.translation, ahead)
    camera.animation_data_clear()
    for metres in np.linspace(0.0, WAY * (place - start.translation).length if hit else 0.0, PLACES):
        camera.matrix_world = Matrix.Translation(ahead * metres) @ start
        bpy.context.view_layer.update()
        yield float(metres)


def figure_5_6(options):
    """Occupancy by the geometry and by what the camera sees, and their times, as the view closes in."""
    scene = light.Light(options.scene or stage.our_scene("canyon"), options.pixels)
    places, rows = [], {}
    for metres in approach(scene.scene):
        taken = stage.by_turns({name: {"occupancy": name, "bounces": 1, **ONE_VOLUME} for name in ("geometry", "depth")}, lambda chosen: scene.cached(1, **chosen), options.repeat)
        places.append(metres)
        rows[f"{metres:.1f} m"] = {f"{name} {what}": value for name, shots in taken.items()
                                   for what, value in (("occupancy", occupied(shots[-1])), ("ms", light.cache_milliseconds(shots)))}
    title = f"{scene.path.stem}, one bounce, {scene.size[0]}x{scene.size[1]}"
    tables.show(f"Figure 5.6: the camera's way into {title}", rows,
                {"geometry occupancy": ".1%", "geometry ms": ".2f", "depth occupancy": ".1%", "depth ms": ".2f"})
    drawn = {what: {f"cells by {name}": [row[f"{name} {column}"] for row in rows.values()] for name in ("geometry", "depth")}
             for what, column in (("share of cells that hold light", "occupancy"), ("time of the cache, ms", "ms"))}
    plots.lines(options.pictures, f"figure_5_6_{scene.path.stem}", title, "way of the camera, m", places, drawn)
    return {"scene": scene.path.stem, "rows": rows}


def figure_5_12(options):
    """Time of the cache's stages, summed in their order, against resolution."""
    scene = light.Light(options.scene or stage.our_scene("canyon"), options.pixels)
    taken = stage.by_turns({str(side): {"resolution": side, "bounces": 2, **ONE_VOLUME} for side in RESOLUTIONS}, lambda chosen: scene.cached(1, **chosen), options.repeat)
    stages = list(dict.fromkeys(name for shots in taken.values() for name in shots[-1].times() if name.startswith(light.CACHE)))
    times = {name: [stage.median_milliseconds(shots, name) for shots in taken.values()] for name in stages}
    rows = {side: {"occupancy": occupied(shots[-1])} for side, shots in taken.items()}
    for name, summed in zip(stages, np.cumsum(list(times.values()), axis=0)):
        for row, milliseconds in zip(rows.values(), summed):
            row[name] = float(milliseconds)
    title = f"{scene.path.stem}, two bounces, {scene.size[0]}x{scene.size[1]}"
    tables.show(f"Figure 5.12: cumulative ms of the stages on {title}", rows, {"occupancy": ".1%", **{name: ".2f" for name in stages}})
    plots.stacks(options.pictures, f"figure_5_12_{scene.path.stem}", f"{title}; above: cells that hold light", "cells along the longest side", "time, ms",
                 {side: f"{row['occupancy']:.0%}" for side, row in rows.items()}, {light.stage_of(name): values for name, values in times.items()})
    return {"scene": scene.path.stem, "rows": rows}


PARTS = {"5.1": table_5_1, "5.6": figure_5_6, "5.8": compressed.figure_5_8, "5.11": compressed.figure_5_11, "5.12": figure_5_12}


def run(options):
    """Measures and prints; returns what was found."""
    return {name: PARTS[name](options) for name in options.parts or PARTS}
