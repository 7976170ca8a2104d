# SPDX-License-Identifier: GPL-3.0-or-later
"""How long traced paths take beside Cycles, and how much noise they leave; a measurement, never a test.

    ./panoptes bench paths [--size 480x270] [--scene FILE.blend] [--samples 64] [--repeat 1] [--json]
    ./panoptes bench paths --figure 7.8 [--pictures FOLDER] [the same options]
    blender -b --factory-startup -P tests/bench/paths_vs_cycles.py -- [the same options]

Both engines render the same samples a pixel with the same limits, on the processor: no adaptive sampling, no denoising,
no clamping. Measured is one bpy.ops.render.render in a fresh process, by turns:

    seconds  wall time of all: reading the scene, building structures, compiling, tracing
    cpu      processor time of all threads, which hardly depends on what else the machine does
    rmse     of Combined against the finished picture reference/NAME.exr beside the scene, where there is one of that
             size; linear
    even     seconds until the noise would be that of Cycles: seconds times the square of the quotient of both RMSE

With --figure, a figure of the dissertation is made anew in place of this: figures.py says which there are, and how.
"""

import argparse
import json
import statistics
import sys
import tempfile
from pathlib import Path

import bpy

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[1] / "metrics")]
import engines  # noqa: E402
import figures  # noqa: E402
import images  # noqa: E402
import metrics  # noqa: E402
from engines import ENGINES, ROOT  # noqa: E402

# What the finished pictures were made with.
BOUNCES = 8


def parse_options():
    parser = argparse.ArgumentParser(prog="panoptes bench paths", description=__doc__.splitlines()[0])
    parser.add_argument("--size", default="480x270", help="width x height in pixels")
    parser.add_argument("--scene", help="a .blend; Sponza beside the checkout if there is one, else our atrium")
    parser.add_argument("--samples", type=int, default=64, help="of both engines")
    parser.add_argument("--repeat", type=int, default=1,
                        help="processes for each engine, or renders of each part of a figure; the median counts")
    parser.add_argument("--figure", choices=figures.FIGURES, help="make this figure of the dissertation")
    parser.add_argument("--pictures", metavar="FOLDER", help="with --figure: write it there as a PNG")
    parser.add_argument("--json", action="store_true", help="print every measurement as JSON")
    parser.add_argument("--out", help=argparse.SUPPRESS)
    parser.add_argument("--child", choices=ENGINES, help=argparse.SUPPRESS)
    options = parser.parse_args(engines.own_arguments())
    engines.complete(parser, options)
    if options.pictures and not options.figure:
        parser.error("--pictures needs --figure.")
    if options.pictures and not Path(options.pictures).is_dir():
        parser.error(f"there is no folder {options.pictures}.")
    return options


# --- in a process of one engine -----------------------------------------------------------------------------


def run_child(options):
    """Renders once, stores the picture and prints the measurements."""
    engines.register(options.child)
    bpy.ops.wm.open_mainfile(filepath=options.scene)
    scene = bpy.context.scene
    engines.choose(scene, options.child, (options.width, options.height), options.samples)
    engines.choose_paths(scene, options.samples, BOUNCES)
    found = engines.measure(scene)
    engines.save_picture(scene, options.out)
    engines.report(found)


# --- the run ------------------------------------------------------------------------------------------------


def error(picture, scene):
    """RMSE of a picture against the finished one of its scene; None where there is none of that size."""
    path = Path(scene).parent / "reference" / f"{Path(scene).stem}.exr"
    if not path.is_file():
        return None
    reference, ours = images.read_pass(path), images.read_pass(picture)
    return metrics.rmse(ours, reference) if ours.shape == reference.shape else None


def main():
    options = parse_options()
    if options.child and options.figure:
        figures.run_child(options)
        return
    if options.child:
        run_child(options)
        return
    if options.figure:
        figures.run(options, __file__)
        return
    runs = {engine: [] for engine in ENGINES}
    with tempfile.TemporaryDirectory() as folder:
        out = str(Path(folder) / "picture.exr")
        arguments = ["--size", options.size, "--scene", options.scene, "--samples", str(options.samples), "--out", out]
        for engine in engines.in_turns(options.repeat):
            runs[engine].append({**engines.child(__file__, engine, arguments), "rmse": error(out, options.scene)})
    rows = {engine: {"seconds": statistics.median(run["seconds"] for run in found),
                     "cpu": statistics.median(run["cpu_seconds"] for run in found), "rmse": found[0]["rmse"]}
            for engine, found in runs.items()}
    theirs = rows["CYCLES"]["rmse"]
    for row in rows.values():
        row["even"] = row["seconds"] * (row["rmse"] / theirs) ** 2 if theirs else None
    if options.json:
        print(json.dumps({"scene": options.scene, "size": [options.width, options.height], "samples": options.samples,
                          "engines": rows, "runs": runs}, indent=1))
        return
    print(f"{Path(options.scene).name} at {options.width}x{options.height}, {options.samples} samples, median of {options.repeat}")
    print(f"{'':10}{'seconds':>10}{'cpu':>10}{'rmse':>10}{'even':>10}")
    for engine, row in rows.items():
        print(f"{engine.title():10}{row['seconds']:10.2f}{row['cpu']:10.2f}" + "".join(
            f"{'-' if row[name] is None else format(row[name], form):>10}" for name, form in (("rmse", ".4f"), ("even", ".2f"))))


main()
