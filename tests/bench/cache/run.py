# SPDX-License-Identifier: GPL-3.0-or-later
"""How good and how fast the radiance cache is; a measurement, never a test.

    ./panoptes bench cache [--section NAME ...] [--scene FILE.blend] [--size 240x135] [--pictures FOLDER] [--json]
    blender -b --factory-startup -P tests/bench/cache/run.py -- [the same options]

Sections, each of one or more tables; the dissertation's figures that they answer to are in brackets:

    error      DiffInd against our paths and Cycles', for each encoding and 1 to 3 bounces  [5.8, 5.9]
    ladders    what each setting is worth: resolution, samples of reflective shadow maps, directions, steps, ...
    speed      what occupancy and encodings save, by Table 5.1's own definition; the camera's way, encodings beside each
               other, times of the stages  [Table 5.1, 5.6, 5.8, 5.11, 5.12]
    leaks      what does not pass thin walls, beside cells that light both sides of them
    inside     the cache's debug pictures: voxels, cells, their light, and what of it is clipped  [5.4, 5.5, 5.7]
    stability  flicker while a lamp and the camera move slowly
    frame      a whole picture after an edit, beside Cycles' first sample

Pictures have the scene's own shape and are as large as fits into --size. On a machine without a GPU times are those of a
software renderer; ratios are what counts.
"""

import argparse
import json
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent), str(HERE.parents[1] / "metrics")]

import error  # noqa: E402
import frame  # noqa: E402
import inside  # noqa: E402
import ladders  # noqa: E402
import leaks  # noqa: E402
import speed  # noqa: E402
import stability  # noqa: E402
from engines import ENGINES, own_arguments  # noqa: E402

SECTIONS = {"error": error.run, "ladders": ladders.run, "speed": speed.run, "leaks": leaks.run,
            "inside": inside.run, "stability": stability.run, "frame": frame.run}


def parse_options():
    parser = argparse.ArgumentParser(prog="panoptes bench cache", description=__doc__.splitlines()[0])
    parser.add_argument("--section", dest="sections", action="append", choices=SECTIONS, help="only this one; may be repeated")
    parser.add_argument("--scene", type=Path, help="a .blend in place of those that a section has by itself")
    parser.add_argument("--size", default="240x135", help="width x height in pixels")
    parser.add_argument("--samples", type=int, default=8, help="of the film, of every picture from the cache")
    parser.add_argument("--reference-samples", type=int, default=256, help="of pictures by paths")
    parser.add_argument("--encoding", dest="encodings", action="append", choices=error.ENCODINGS, help="error: only this one; may be repeated")
    parser.add_argument("--bounces", type=int, action="append", metavar="N", help="error: only so many; may be repeated")
    parser.add_argument("--ladder", dest="ladders", action="append", choices=ladders.LADDERS, help="ladders: only this one; may be repeated")
    parser.add_argument("--part", dest="parts", action="append", choices=speed.PARTS, help="speed: only this one; may be repeated")
    parser.add_argument("--frames", type=int, default=12, help="stability: so many that follow each other")
    parser.add_argument("--flicker-samples", type=int, default=64, help="stability: of each frame by paths")
    parser.add_argument("--frame-samples", type=int, action="append", metavar="N", help="frame: of the film; may be repeated")
    parser.add_argument("--repeat", type=int, default=3, help="of what is timed; the median counts")
    parser.add_argument("--pictures", metavar="FOLDER", type=Path, help="write pictures and plots there as PNG")
    parser.add_argument("--json", action="store_true", help="print every measurement as JSON behind the tables")
    parser.add_argument("--out", help=argparse.SUPPRESS)
    parser.add_argument("--child", choices=ENGINES, help=argparse.SUPPRESS)
    options = parser.parse_args(own_arguments())
    try:
        options.pixels = tuple(int(part) for part in options.size.lower().split("x"))
        width, height = options.pixels
    except ValueError:
        parser.error(f"the size {options.size} is not WIDTHxHEIGHT.")
    options.encodings = options.encodings or error.ENCODINGS
    options.bounces = options.bounces or (1, 2, 3)
    options.frame_samples = options.frame_samples or (1, 4, 8)
    if min(width, height, options.samples, options.reference_samples, options.flicker_samples, options.repeat, *options.bounces, *options.frame_samples) < 1:
        parser.error("sizes and counts must be at least 1.")
    if options.frames < 2:
        parser.error("flicker is between frames: there must be at least 2.")
    if options.scene and not options.scene.is_file():
        parser.error(f"there is no scene at {options.scene}.")
    if options.pictures and not options.pictures.is_dir():
        parser.error(f"there is no folder {options.pictures}.")
    options.script = __file__
    return options


def main():
    options = parse_options()
    if options.child:
        frame.run_child(options)
        return
    found = {name: SECTIONS[name](options) for name in options.sections or SECTIONS}
    if options.json:
        print(json.dumps(found, indent=1))


main()
