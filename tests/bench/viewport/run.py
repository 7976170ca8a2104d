# SPDX-License-Identifier: GPL-3.0-or-later
"""How soon a 3D View shows an edit, beside Cycles; a measurement, never a test.

    ./panoptes bench viewport [--scene FILE.blend] [--frames FILE.blend] [--window 640x480] [--repeat N] [--pictures FOLDER] [--json]

Each engine has a Blender of its own, with a window on a virtual display; they run in turns. An edit moves the scene's
first mesh there and back; --frames names a scene whose next frame is the edit, and which is played besides. "first" is the first change in the view,
"full" the last: then one sample of all pixels is there, of Cycles one path a pixel, of Panoptes one of Real-time. The
error is sRGB RMSE, in eight bits, against Cycles' view of many samples.
"""

import argparse
import json
import shutil
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import bpy
import numpy as np

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent), str(HERE.parents[1] / "metrics")]

import engines  # noqa: E402
import tables  # noqa: E402

WINDOW_LIMIT_SECONDS = 900


def parse_options():
    parser = argparse.ArgumentParser(prog="panoptes bench viewport", description=__doc__.splitlines()[0])
    parser.add_argument("--scene", help="whose first mesh is moved")
    parser.add_argument("--frames", help="a scene that goes from frame to frame")
    parser.add_argument("--window", dest="size", default="640x480", help="width x height of Blender's window in pixels")
    parser.add_argument("--samples", type=int, default=64, help="of the reference")
    parser.add_argument("--repeat", type=int, default=3, help="rounds; the median over their edits counts")
    parser.add_argument("--edits", type=int, default=4, help="in each round; the first, which compiles, does not count")
    parser.add_argument("--pictures", metavar="FOLDER", type=Path, help="write what the views show there as PNG")
    parser.add_argument("--json", action="store_true", help="print every measurement as JSON behind the tables")
    options = parser.parse_args(engines.own_arguments())
    deforming = engines.ROOT.parent / "shared" / "scenes" / "igea_deform.blend"
    options.frames = options.frames or (str(deforming) if deforming.is_file() and not options.scene else None)
    engines.complete(parser, options)
    if options.frames and not Path(options.frames).is_file():
        parser.error(f"there is no scene at {options.frames}.")
    if options.edits < 2:
        parser.error("the first edit does not count: there must be at least 2.")
    if options.pictures and not options.pictures.is_dir():
        parser.error(f"there is no folder {options.pictures}.")
    if not (shutil.which("xvfb-run") and shutil.which("xauth")):
        parser.error("there is no virtual display: install xvfb and xauth.")
    return options


def in_window(options, **job):
    """What window.py finds: (its dictionary, the picture at the end, uint8[H, W, 3], row 0 at the bottom)."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "job.json"
        path.write_text(json.dumps({**job, "out": folder, "screen": str(Path(folder) / "Xvfb_screen0")}), encoding="utf-8")
        width, height = options.width, options.height
        done = subprocess.run(
            ["xvfb-run", "-a", "-s", f"-screen 0 {width}x{height}x24 -nocursor -fbdir {folder}", bpy.app.binary_path, "--factory-startup",
             "--window-geometry", "0", "0", str(width), str(height), "-P", str(HERE / "window.py"), "--", str(path)],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=WINDOW_LIMIT_SECONDS, check=False)
        found = Path(folder) / "found.json"
        if done.returncode != 0 or not found.is_file():
            tail = [line for line in done.stdout.splitlines() if line.strip()][-8:]
            sys.exit(f"{job['engine']} did not render in a window (status {done.returncode}):\n" + "\n".join(tail))
        return json.loads(found.read_text(encoding="utf-8")), np.load(Path(folder) / "picture.npy")


def rmse(picture, reference):
    """sRGB RMSE of two pictures of eight bits."""
    return float(np.sqrt(np.mean((picture.astype(np.float64) - reference) ** 2)) / 255.0)


def save(options, name, picture):
    """Writes a picture, row 0 at the bottom."""
    if not options.pictures:
        return
    height, width = picture.shape[:2]
    image = bpy.data.images.new(name, width, height)
    image.pixels.foreach_set(np.dstack([picture / np.float32(255), np.ones((height, width), np.float32)]).astype(np.float32).ravel())
    image.filepath_raw, image.file_format = str(options.pictures / f"{name}.png"), "PNG"
    image.save()
    bpy.data.images.remove(image)


def measure(options, scene, kind):
    """Both engines on one scene, in turns; prints a table."""
    stem = Path(scene).stem
    _, reference = in_window(options, scene=scene, engine="CYCLES", samples=options.samples, edits=options.edits, kind=kind)
    save(options, f"viewport_{stem}_reference", reference)
    edits, errors, size = {engine: [] for engine in engines.ENGINES}, {}, None
    for engine in engines.in_turns(options.repeat):
        found, picture = in_window(options, scene=scene, engine=engine, samples=1, edits=options.edits, kind=kind)
        edits[engine] += found["edits"][1:]
        errors[engine], size = rmse(picture, reference), found["size"]
        save(options, f"viewport_{stem}_{engine.lower()}", picture)
    rows = {}
    for engine, runs in edits.items():
        full = statistics.median(run["full"] for run in runs)
        rows[engine] = {"first s": statistics.median(run["first"] for run in runs), "full s": full, "a second": 1.0 / full,
                        "rmse": errors[engine]}
    what = "next frame" if kind == "frame" else "moved object"
    tables.show(f"viewport: {stem}, {what}, 3D View of {size[0]}x{size[1]}, median of {len(edits['CYCLES'])} edits", rows,
                {"first s": ".3f", "full s": ".3f", "a second": ".2f", "rmse": ".4f"})
    return {"scene": stem, "kind": kind, "size": size, "rows": rows, "edits": edits}


def play(options, scene):
    """Both engines while Blender plays the animation, every frame of it, as coarse as they then are; prints a table."""
    runs = {engine: [] for engine in engines.ENGINES}
    for engine in engines.in_turns(options.repeat):
        found, picture = in_window(options, scene=scene, engine=engine, samples=1, edits=0, kind="play")
        runs[engine] += found["edits"]
        save(options, f"viewport_{Path(scene).stem}_played_{engine.lower()}", picture)
    rows = {engine: {"a second": statistics.median(run["pictures"] / run["seconds"] for run in found)}
            for engine, found in runs.items()}
    tables.show(f"viewport: {Path(scene).stem}, played", rows, {"a second": ".2f"})
    return {"scene": Path(scene).stem, "kind": "play", "rows": rows, "runs": runs}


def main():
    options = parse_options()
    found = [measure(options, options.scene, "move")]
    if options.frames:
        found += [measure(options, options.frames, "frame"), play(options, options.frames)]
    if options.json:
        print(json.dumps({"viewport": found}))


main()
