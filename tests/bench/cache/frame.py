# SPDX-License-Identifier: GPL-3.0-or-later
"""A whole picture after an edit, beside Cycles' first sample: the section frame.

The edit moves the scene's first mesh and, the next time, back; measured is one bpy.ops.render.render of the scene as it
is in the file: Blender's own work, synchronisation, light, and handing over the picture. Each engine has a process of
its own, in turns; renders that compile or read the scene for the first time do not count.

    CYCLES       one sample, what rests is kept between renders ("persistent data"): no more than the edit is synchronised
    CYCLES anew  the same without, as files are by themselves
    PANOPTES N   Real-time, antialiased by N samples of the film

The error is sRGB RMSE of the picture after the edit that moves back, against the finished picture of Cycles.
"""

import json
import statistics
import tempfile
from pathlib import Path

import bpy
import engines
import images
import light
import metrics
import tables

SCENES = ("sponza_crytek", "cornell", "igea_deform", "foliage_ivy_oak", "canyon", "two_spots", "doorway")
MOVE_METRES = 0.01
BOUNCES = 2
WARM_UPS = {"CYCLES": 1, "PANOPTES": 3}
# So many of the slowest passes are named.
SLOWEST = 6


# --- in a process of one engine ---------------------------------------------------------------------------------


def variants(options):
    """{row: (samples, whether what rests is kept)} of the engine whose process this is."""
    if options.child == "CYCLES":
        return {"CYCLES": (1, True), "CYCLES anew": (1, False)}
    return {f"PANOPTES {samples}": (samples, False) for samples in options.frame_samples}


def set_up(options, samples, kept):
    """Opens the scene and sets what is measured."""
    bpy.ops.wm.open_mainfile(filepath=str(options.scene))
    scene = bpy.context.scene
    engines.choose(scene, options.child, options.pixels, samples)
    scene.render.use_persistent_data = kept
    if options.child == "CYCLES":
        engines.choose_paths(scene, samples, BOUNCES)
    else:
        scene.panoptes.bounces = BOUNCES
    return scene


def run_child(options):
    """Renders after edits, stores the last picture of each row in the folder options.out and prints the measurements."""
    engines.register(options.child)
    found = {}
    for name, (samples, kept) in variants(options).items():
        scene = set_up(options, samples, kept)
        moved = next(thing for thing in scene.objects if thing.type == "MESH")
        place, runs = moved.location.x, []
        for turn in range(WARM_UPS[options.child] + 2 * options.repeat):
            moved.location.x = place + MOVE_METRES * ((turn + WARM_UPS[options.child]) % 2 == 0)
            run = engines.measure(scene)
            if turn >= WARM_UPS[options.child]:
                runs.append(run)
        found[name] = {key: statistics.median(run[key] for run in runs) for key in runs[0]}
        if options.child == "PANOPTES":
            found[name]["passes"] = json.loads(scene.panoptes.last_stats)["passes"]
        engines.save_picture(scene, Path(options.out) / f"{name}.exr")
    engines.report(found)


# --- the run ----------------------------------------------------------------------------------------------------


def measure(path, options, script):
    """Both engines on one scene."""
    scene = light.Light(path, options.pixels)
    reference = scene.finished(options.reference_samples)
    rows = {}
    with tempfile.TemporaryDirectory() as folder:
        arguments = ["--scene", str(path), "--size", "x".join(map(str, scene.size)), "--repeat", str(options.repeat), "--out", folder,
                     *(word for samples in options.frame_samples for word in ("--frame-samples", str(samples)))]
        for engine in engines.ENGINES:
            for name, found in engines.child(script, engine, arguments).items():
                picture = images.read_pass(Path(folder) / f"{name}.exr")
                rows[name] = {"s": found["seconds"], "cpu s": found["cpu_seconds"], "sync ms": found.get("sync_ms"),
                              "srgb rmse": metrics.srgb_rmse(picture, reference), "mean": float(picture.mean() / reference.mean()),
                              "passes": found.get("passes")}
    return {"size": scene.size, "rows": rows}


def slowest(row):
    """The passes that take most of the time, in words."""
    passes = sorted(row["passes"], key=lambda entry: -entry["ms"])[:SLOWEST]
    return ", ".join(f"{entry['name']} {entry['ms']:.0f}" for entry in passes)


def run(options):
    """Measures and prints; returns what was found."""
    found = {}
    for path in light.paths_of(options, SCENES):
        scene = found[path.stem] = measure(path, options, options.script)
        tables.show(f"frame: {path.stem}, {scene['size'][0]}x{scene['size'][1]}, {BOUNCES} bounces, after an edit; median of {2 * options.repeat}",
                    scene["rows"], {"s": ".3f", "cpu s": ".3f", "sync ms": ".1f", "srgb rmse": ".4f", "mean": ".4f"})
        for name, row in scene["rows"].items():
            if row["passes"]:
                print(f"{name}: ms of {slowest(row)}")
        print(flush=True)
    return found
