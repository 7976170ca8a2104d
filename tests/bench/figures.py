# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures of the dissertation, rendered by our paths on a scene like its Sponza.

7.8  Three kinds of light, each by three structures, and by Cycles with the same limits. What a ray may be is told
     by the light that there is:
         a  primary and shadow rays: lamps without extent, no bounce
         b  primary and secondary rays: a world of one colour, which only scattered rays find, so that there is no
            shadow ray
         c  primary, secondary and shadow rays: the lamps of (a), one bounce
     Pictures of the structures must be the same to the bit.
7.9  What the camera sees alone, with lamps' shadows from maps and a rasterised first hit, beside all that is exact;
     lit as the scene is, one bounce. The error is what the speed costs.

Each part is rendered in the same process, several times: first with an object moved by a millimetre, so that
everything is compiled, then with it moved back, so that the structure is built anew, as for an animation's frame.

    build ms      what comes before the first sample: triangles gathered, structure built
    ms a sample   the tracing and shading of one sample of all pixels
    Mrays/s       rays of all kinds in that time; those that go on behind a transparent surface count again
"""

import json
import statistics
import tempfile
from pathlib import Path
from typing import NamedTuple

import bpy
import compare
import engines
import images
import metrics
import numpy as np
import relight

STRUCTURES = ("orthographic", "cube", "bvh")
MOVE_METRES = 0.001
# llvmpipe still compiles in the second render of a process.
WARM_UPS = 2
# Where in a figure's picture the brightest tenth of the pixels begins, linear.
BRIGHT = 0.7


class Part(NamedTuple):
    """One picture of a figure, whoever renders it."""
    title: str
    light: str  # a function of relight.py, or "" to leave the scene as it is
    bounces: int
    variants: dict  # name: settings of `Scene.panoptes.primitive`


_BY_STRUCTURE = {name: {"structure": name} for name in STRUCTURES}
FIGURES = {
    "7.8": {
        "a": Part("primary and shadow rays", "by_lamps", 0, _BY_STRUCTURE),
        "b": Part("primary and secondary rays", "by_world", 0, _BY_STRUCTURE),
        "c": Part("primary, secondary and shadow rays", "by_lamps", 1, _BY_STRUCTURE),
    },
    "7.9": {
        "view": Part("one view with maps beside exact rays", "", 1, {
            "fast": {"structure": "view", "shadows": "MAPS", "primary": "RASTERISED"},
            "full": {"structure": "auto", "shadows": "RAYS", "primary": "TRACED"},
        }),
    },
}


# --- in a process of one engine -----------------------------------------------------------------------------


def picture_path(folder, part, variant):
    """Where a child leaves a picture for its parent; the variant CYCLES is theirs."""
    return Path(folder) / f"{part}_{variant}.exr"


def median(runs):
    """Each measurement's median."""
    return {name: statistics.median(run[name] for run in runs) for name in runs[0]}


def render(scene, options, bounces):
    """Measures renders of a scene that changed since the last; the first ones, which compile, do not count."""
    moved = next(thing for thing in scene.objects if thing.type == "MESH")
    place = moved.location.x
    warm_ups, runs = WARM_UPS if options.child == "PANOPTES" else 0, []
    for _ in range(options.repeat):
        engines.choose_paths(scene, 1, bounces)
        for turn in range(warm_ups):
            moved.location.x = place + (turn + 1) * MOVE_METRES
            engines.measure(scene)
        warm_ups = 1
        engines.choose_paths(scene, options.samples, bounces)
        moved.location.x = place
        runs.append(engines.measure(scene))
    return median(runs)


def run_child(options):
    """Renders all parts of a figure, stores the pictures in the folder options.out and prints the measurements."""
    engines.register(options.child)
    found = {}
    for name, part in FIGURES[options.figure].items():
        bpy.ops.wm.open_mainfile(filepath=options.scene)
        scene = bpy.context.scene
        engines.choose(scene, options.child, (options.width, options.height))
        if part.light:
            getattr(relight, part.light)(scene)
        variants = part.variants if options.child == "PANOPTES" else {options.child: {}}
        found[name] = {}
        for variant, settings in variants.items():
            for key, value in settings.items():
                setattr(scene.panoptes.primitive, key, value)
            found[name][variant] = render(scene, options, part.bounces)
            engines.save_picture(scene, picture_path(options.out, name, variant))
    engines.report(found)


# --- the run ------------------------------------------------------------------------------------------------


def row(run, options):
    """What a table shows of the measurements of one variant."""
    return {"build_ms": run["build_ms"], "sample_ms": run["trace_ms"] / options.samples,
            "mrays": run["rays"] / run["trace_ms"] / 1000.0,
            "rays_a_pixel": run["rays"] / (options.width * options.height * options.samples)}


def judge_7_8(rows, pictures):
    """Adds the errors: against the first structure's picture and against that of Cycles, as noisy as ours."""
    for part, variants in rows.items():
        first, theirs = pictures[part][STRUCTURES[0]], pictures[part]["CYCLES"]
        for variant, found in variants.items():
            ours = pictures[part][variant]
            found["rmse_of_structures"] = metrics.rmse(ours, first)
            found["rmse_of_cycles"] = metrics.rmse(ours, theirs)
            found["mean_of_cycles"] = float(ours.mean() / theirs.mean())


def judge_7_9(rows, pictures):
    """Adds the fast picture's error and how often its time fits into the other's."""
    found, shown = rows["view"], pictures["view"]
    found["fast"]["relative_rmse"] = metrics.relative_rmse(shown["fast"], shown["full"])
    for time in ("build_ms", "sample_ms"):
        found["fast"][f"{time}_ratio"] = found["full"][time] / found["fast"][time]


def exposed(picture):
    """Makes a linear picture as bright as it is looked at best."""
    bright = np.quantile(picture, 0.9)
    return picture * (BRIGHT / bright if bright > 0.0 else 1.0)


def write_pictures(options, pictures):
    """The three cases side by side, or both settings and their difference."""
    if options.figure == "7.8":
        shown = np.concatenate([exposed(part[STRUCTURES[0]]) for part in pictures.values()], axis=1)
    else:
        both = exposed(np.concatenate([pictures["view"][variant] for variant in ("fast", "full")], axis=1))
        shown = compare.difference_picture(*np.split(both, 2, axis=1), 1.0)
    images.write_png(Path(options.pictures) / f"figure_{options.figure.replace('.', '_')}.png", shown)


COLUMNS = {"build_ms": ("build ms", ".1f"), "sample_ms": ("ms a sample", ".1f"), "mrays": ("Mrays/s", ".2f"),
           "rays_a_pixel": ("rays a pixel", ".2f"), "rmse_of_structures": ("rmse", "g"),
           "rmse_of_cycles": ("of Cycles", ".4f"), "mean_of_cycles": ("mean", ".4f"),
           "relative_rmse": ("error", ".4f"), "build_ms_ratio": ("build ratio", ".2f"),
           "sample_ms_ratio": ("sample ratio", ".2f")}


def print_table(options, rows):
    """One line for each part and variant."""
    print(f"Figure {options.figure}: {Path(options.scene).name} at {options.width}x{options.height}, "
          f"{options.samples} samples, median of {options.repeat}")
    shown = [name for name in COLUMNS if any(name in found for variants in rows.values() for found in variants.values())]
    for part, variants in rows.items():
        print(f"({part}) {FIGURES[options.figure][part].title}")
        print(f"{'':14}" + "".join(f"{COLUMNS[name][0]:>14}" for name in shown))
        for variant, found in variants.items():
            print(f"{variant:14}" + "".join(f"{format(found[name], COLUMNS[name][1]) if name in found else '-':>14}" for name in shown))


def run(options, script):
    """Makes a figure; `script` is what runs again in the processes of the engines."""
    parts = FIGURES[options.figure]
    rendering = engines.ENGINES if options.figure == "7.8" else ("PANOPTES",)
    with tempfile.TemporaryDirectory() as folder:
        arguments = ["--figure", options.figure, "--size", options.size, "--scene", options.scene, "--samples",
                     str(options.samples), "--repeat", str(options.repeat), "--out", folder]
        runs = {engine: engines.child(script, engine, arguments) for engine in rendering}
        rows = {part: {variant: row(found, options) for variant, found in variants.items()}
                for part, variants in runs["PANOPTES"].items()}
        pictures = {part: {variant: images.read_pass(picture_path(folder, part, variant))
                           for engine in rendering for variant in runs[engine][part]} for part in parts}
    (judge_7_8 if options.figure == "7.8" else judge_7_9)(rows, pictures)
    if options.pictures:
        write_pictures(options, pictures)
    if options.json:
        print(json.dumps({"figure": options.figure, "scene": options.scene, "size": [options.width, options.height],
                          "samples": options.samples, "parts": rows, "runs": runs}, indent=1))
    else:
        print_table(options, rows)
