# SPDX-License-Identifier: GPL-3.0-or-later
"""What ambient occlusion by several views is worth, and what it costs; a measurement, never a test.

    ./panoptes bench occlusion [--section NAME ...] [--scene FILE.blend] [--size 240x135] [--pictures FOLDER] [--json]
    blender -b --factory-startup -P tests/bench/occlusion/run.py -- [the same options]

Sections, each a table; the dissertation's figures that they answer to are in brackets:

    error      RMSE of the AO pass against traced occlusion, by the camera alone, with lamps' maps, with the phantom
               pair, over all surfaces and over those that a lamp lights  [4.9, 4.11]
    init       the first samples by which the rest are dealt out: difference to no such dealing, and time  [4.8]
    phantoms   resolutions of the phantom views: error and time  [4.12]
    stability  how much occlusion of resting points changes while the camera moves  [the video of 4.4.2]
    cost       time of one, two and three views beside the samples that they take  [4.7]

"ms" is per sample of the film. On a machine without a GPU times are those of a software renderer; ratios are what counts.
"""

import argparse
import json
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent), str(HERE.parents[1] / "metrics")]

import cost  # noqa: E402
import error  # noqa: E402
import stability  # noqa: E402
import variants  # noqa: E402
from engines import own_arguments  # noqa: E402

SECTIONS = {"error": error.run, "init": cost.init, "phantoms": cost.phantoms, "stability": stability.run, "cost": cost.cost}


def parse_options():
    parser = argparse.ArgumentParser(prog="panoptes bench occlusion", description=__doc__.splitlines()[0])
    parser.add_argument("--section", dest="sections", action="append", choices=SECTIONS, help="only this one; may be repeated")
    parser.add_argument("--scene", type=Path, help="a .blend in place of those that a section has by itself")
    parser.add_argument("--size", default="240x135", help="width x height in pixels")
    parser.add_argument("--samples", type=int, default=16, help="of the film, of every picture by views")
    parser.add_argument("--reference-samples", type=int, default=256, help="of pictures by rays")
    parser.add_argument("--distance", type=float, help="range of occlusion in metres; else a share of the scene's size")
    parser.add_argument("--estimator", dest="estimators", action="append", choices=variants.ESTIMATORS, help="only this one; may be repeated")
    parser.add_argument("--repeat", type=int, default=5, help="of what is timed; the median counts")
    parser.add_argument("--every", type=int, default=1, metavar="N", help="stability: only every n-th frame")
    parser.add_argument("--pictures", metavar="FOLDER", type=Path, help="write pictures there as PNG")
    parser.add_argument("--json", action="store_true", help="print every measurement as JSON behind the tables")
    options = parser.parse_args(own_arguments())
    try:
        options.pixels = tuple(int(part) for part in options.size.lower().split("x"))
        width, height = options.pixels
    except ValueError:
        parser.error(f"the size {options.size} is not WIDTHxHEIGHT.")
    if min(width, height, options.samples, options.reference_samples, options.repeat, options.every) < 1:
        parser.error("sizes and counts must be at least 1.")
    if options.distance is not None and not options.distance > 0.0:
        parser.error("the range must be above 0 m.")
    if options.scene and not options.scene.is_file():
        parser.error(f"there is no scene at {options.scene}.")
    if options.pictures and not options.pictures.is_dir():
        parser.error(f"there is no folder {options.pictures}.")
    options.estimators = options.estimators or variants.ESTIMATORS
    return options


def main():
    options = parse_options()
    found = {name: SECTIONS[name](options) for name in options.sections or SECTIONS}
    if options.json:
        print(json.dumps(found, indent=1))


main()
