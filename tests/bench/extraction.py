# SPDX-License-Identifier: GPL-3.0-or-later
"""How long a mesh of a million triangles takes from Blender into the engine; a measurement, never a test.

    ./panoptes bench extraction [--triangles 1000000] [--repeat 7] [--auto-smooth] [--json]
    blender -b --factory-startup -P tests/bench/extraction.py -- [the same options]

Two ways are compared, in turn, in one process: by foreach_get into arrays, and by the native module from
Blender's memory (3.4 alone). The mesh has smooth quads and a UV map.

    blender   what both need of Blender: triangles, and normals where it has to compute them
    extract   until everything that rendering needs lies in our own memory
    hand over until the engine holds it: fingerprint, and for arrays the making of the native mesh
"""

import argparse
import json
import statistics
import sys
import time
from pathlib import Path

import bpy

ROOT = Path(__file__).resolve().parents[2]


def parse_options():
    parser = argparse.ArgumentParser(prog="panoptes bench extraction", description=__doc__.splitlines()[0])
    parser.add_argument("--triangles", type=int, default=1_000_000)
    parser.add_argument("--repeat", type=int, default=7, help="the median counts")
    parser.add_argument("--auto-smooth", action="store_true", help="Blender has to split normals")
    parser.add_argument("--json", action="store_true", help="print every measurement as JSON")
    arguments = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    options = parser.parse_args(arguments)
    if options.triangles < 4 or options.repeat < 1:
        parser.error("there must be at least 4 triangles and 1 repetition.")
    return options


def build(triangles, auto_smooth):
    """A grid of smooth quads with about so many triangles; returns the evaluated object."""
    rows = max(1, round((triangles / 4) ** 0.5))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=max(1, round(triangles / 2 / rows)), y_subdivisions=rows)
    mesh = bpy.context.object.data
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    if hasattr(mesh, "use_auto_smooth"):
        mesh.use_auto_smooth = auto_smooth
    bpy.context.view_layer.update()
    return bpy.context.object.evaluated_get(bpy.context.evaluated_depsgraph_get())


def timed(call):
    began = time.perf_counter()
    found = call()
    return (time.perf_counter() - began) * 1e3, found


def prepare(mesh):
    """What Blender has to do for either way."""
    mesh.calc_loop_triangles()
    if hasattr(mesh, "calc_normals_split"):
        mesh.calc_normals_split()


def measure(thing, engine, read):
    """Milliseconds of extraction and of handing over, where `read` stands in for `memory.read`."""
    from panoptes.sync import Mirror, memory, meshes

    usual, memory.read = memory.read, read or memory.read
    try:
        extract_ms, found = timed(lambda: meshes.extract(thing, 1, (), print))
    finally:
        memory.read = usual
    if read is None and not isinstance(found.mesh, meshes.NativeMesh):
        sys.exit(f"Blender {bpy.app.version_string} is not read by pointer; this measurement is for 3.4.")
    hand_over_ms, _ = timed(lambda: Mirror(engine).put_mesh(1, found.mesh))
    return {"extract": extract_ms, "hand over": hand_over_ms, "all": extract_ms + hand_over_ms}


def main():
    options = parse_options()
    sys.path.insert(0, str(ROOT / "addon"))
    from panoptes import native

    thing = build(options.triangles, options.auto_smooth)
    engine = native.module().Engine()
    blender_ms = [timed(lambda: prepare(thing.data))[0] for _ in range(options.repeat)]
    ways = {"foreach_get": lambda *arguments, **named: None, "memory": None}
    runs = {way: [] for way in ways}
    for _ in range(options.repeat):
        # Taking turns spreads whatever else the machine does over both.
        for way, read in ways.items():
            runs[way].append(measure(thing, engine, read))
    engine.close()
    medians = {way: {part: statistics.median(run[part] for run in found) for part in found[0]}
               for way, found in runs.items()}
    ratios = {part: medians["foreach_get"][part] / medians["memory"][part] for part in medians["memory"]}
    triangles = len(thing.data.loop_triangles)
    if options.json:
        print(json.dumps({"triangles": triangles, "blender_ms": blender_ms, "medians": medians, "ratios": ratios,
                          "runs": runs}, indent=1))
        return
    print(f"{triangles} triangles, median of {options.repeat}, milliseconds")
    print(f"blender (first, then again; part of extract below){blender_ms[0]:8.1f}{statistics.median(blender_ms):8.1f}")
    print(f"{'':12}" + "".join(f"{way:>12}" for way in ways) + f"{'ratio':>8}")
    for part, ratio in ratios.items():
        print(f"{part:12}" + "".join(f"{medians[way][part]:12.1f}" for way in ways) + f"{ratio:8.1f}")


main()
