# SPDX-License-Identifier: GPL-3.0-or-later
"""How long Panoptes takes beside Cycles, in one run on one machine; a measurement, never a test.

    ./panoptes bench [--size 960x540] [--scene FILE.blend] [--repeat 3] [--samples 1] [--json]
    blender -b --factory-startup -P tests/bench/speed_vs_cycles.py -- [the same options]

Measured is the wall time of one bpy.ops.render.render at one sample a pixel: for Cycles that is
synchronisation, BVH and the first sample of its paths; for Panoptes (Real-time) synchronisation, upload
and light. Both spend the same on Blender's side of it (evaluating the scene, storing the result). Each
engine gets processes of its own, in turn, since a process keeps what its first render made:

    first    the first render in a fresh process: everything is read, sent and lit; for Panoptes also the GL
             context and the compiling of its programs
    opened   the file opened again in the same process: Panoptes still has its programs, and images whose
             bytes are the same stay on the GPU
    again    the same file once more

Processor time (of all threads) is shown beside it: unlike wall time it hardly depends on what else the machine does.
The bar (wall, "first" row) is 2 on Sponza at 960x540: twice Cycles' time to synchronise and trace one sample.
"""

import argparse
import json
import statistics
import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))
import engines  # noqa: E402
from engines import ENGINES  # noqa: E402

ROWS = ("first", "opened", "again")


def parse_options():
    parser = argparse.ArgumentParser(prog="panoptes bench", description=__doc__.splitlines()[0])
    parser.add_argument("--size", default="960x540", help="width x height in pixels")
    parser.add_argument("--scene", help="a .blend; Sponza beside the checkout if there is one, else our atrium")
    parser.add_argument("--repeat", type=int, default=3, help="processes for each engine; the median counts")
    parser.add_argument("--samples", type=int, default=1, help="of Panoptes; Cycles always takes one")
    parser.add_argument("--json", action="store_true", help="print every measurement as JSON")
    parser.add_argument("--child", choices=ENGINES, help=argparse.SUPPRESS)
    options = parser.parse_args(engines.own_arguments())
    engines.complete(parser, options)
    return options


# --- in a process of one engine -------------------------------------------------------------------------


def prepare(options):
    """Opens the scene and sets what is measured."""
    bpy.ops.wm.open_mainfile(filepath=options.scene)
    scene = bpy.context.scene
    engines.choose(scene, options.child, (options.width, options.height), options.samples)
    return scene


def run_child(options):
    """Renders thrice and prints the measurements on one line."""
    engines.register(options.child)
    found = {"first": engines.measure(prepare(options))}
    scene = prepare(options)
    found["opened"], found["again"] = engines.measure(scene), engines.measure(scene)
    engines.report(found)


# --- the run --------------------------------------------------------------------------------------------


def main():
    options = parse_options()
    if options.child:
        run_child(options)
        return
    runs = {engine: [] for engine in ENGINES}
    arguments = ["--size", options.size, "--scene", options.scene, "--samples", str(options.samples)]
    for engine in engines.in_turns(options.repeat):
        runs[engine].append(engines.child(__file__, engine, arguments))
    medians = {kind: {row: {engine: statistics.median(run[row][kind] for run in runs[engine]) for engine in ENGINES}
                      for row in ROWS} for kind in ("seconds", "cpu_seconds")}
    ratios = {kind: {row: found["PANOPTES"] / found["CYCLES"] for row, found in rows.items()} for kind, rows in medians.items()}
    if options.json:
        print(json.dumps({"scene": options.scene, "size": [options.width, options.height], "samples": options.samples,
                          "medians": medians, "ratios": ratios, "runs": runs}, indent=1))
        return
    print(f"{Path(options.scene).name} at {options.width}x{options.height}, median of {options.repeat}, seconds")
    print(f"{'':8}{'wall':>24}{'':4}{'processor':>28}")
    print(f"{'':8}" + f"{'Cycles':>10}{'Panoptes':>10}{'ratio':>8}    " * 2)
    for row in ROWS:
        print(f"{row:8}" + "".join(f"{medians[kind][row]['CYCLES']:10.3f}{medians[kind][row]['PANOPTES']:10.3f}"
                                   f"{ratios[kind][row]:8.2f}    " for kind in medians))


main()
