# SPDX-License-Identifier: GPL-3.0-or-later
"""How long large textures take to load, and the memory that they hold, beside Cycles; a measurement, never a test.

    ./panoptes bench textures [--count 8] [--side 4096] [--repeat 3] [--json]
    blender -b --factory-startup -P tests/bench/textures_vs_cycles.py -- [the same options]

The scene is a row of planes with a texture each, PNG and JPEG by turns, made in a temporary folder. Each engine renders
it twice in a process of its own, 32x18 pixels at one sample, after a scene without textures has made whatever is made
once (context, programs, kernels):

    load     the first render less the second one, which finds Panoptes' textures on the GPU; Cycles loads them again,
             so what is taken off is the same scene without textures
    peak     the most memory that the process held while it rendered, less what it held before
    kept     what it holds afterwards, likewise: Cycles frees its scene, Panoptes keeps the textures for the next frame

The bar is a load ratio of 1.
"""

import argparse
import json
import resource
import statistics
import sys
import tempfile
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
import engines  # noqa: E402

SIZE = (32, 18)
COLUMNS = ("load", "cpu", "peak", "kept")


def parse_options():
    parser = argparse.ArgumentParser(prog="panoptes bench textures", description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=8, help="textures")
    parser.add_argument("--side", type=int, default=4096, help="texels a side")
    parser.add_argument("--repeat", type=int, default=3, help="processes for each engine; the median counts")
    parser.add_argument("--json", action="store_true", help="print every measurement as JSON")
    parser.add_argument("--folder", help=argparse.SUPPRESS)
    parser.add_argument("--child", choices=engines.ENGINES, help=argparse.SUPPRESS)
    options = parser.parse_args(engines.own_arguments())
    if min(options.count, options.side, options.repeat) < 1:
        parser.error("counts and sizes must be at least 1.")
    return options


# --- the textures -------------------------------------------------------------------------------------------


def make_textures(folder, count, side):
    """Writes textures that compress about as well as photographs do."""
    random = np.random.default_rng(1)
    steps = np.linspace(0.0, 1.0, side, dtype=np.float32)
    scene = bpy.context.scene
    for i in range(count):
        pixels = np.ones((side, side, 4), np.float32)
        for channel in range(3):
            waves = random.uniform(5.0, 60.0, 2)
            pixels[..., channel] = 0.5 + 0.2 * np.sin(waves[0] * steps) + 0.2 * np.sin(waves[1] * steps)[:, None]
        pixels[..., :3] += random.normal(0.0, 0.02, (side, side, 1)).astype(np.float32)
        image = bpy.data.images.new(f"texture {i}", side, side)
        image.pixels.foreach_set(np.clip(pixels, 0.0, 1.0).reshape(-1))
        kind, ending = (("PNG", "png"), ("JPEG", "jpg"))[i % 2]
        image.file_format = kind
        scene.render.image_settings.file_format = kind
        image.filepath_raw = str(Path(folder) / f"texture_{i}.{ending}")
        image.save()
        bpy.data.images.remove(image)


# --- in a process of one engine -----------------------------------------------------------------------------


def textured(path):
    """A material that shows an image, or a plain one that has the same nodes otherwise."""
    material = bpy.data.materials.new(path.name if path else "plain")
    material.use_nodes = True
    if path:
        tree = material.node_tree
        node = tree.nodes.new("ShaderNodeTexImage")
        node.image = bpy.data.images.load(str(path))
        shader = next(n for n in tree.nodes if n.type == "BSDF_PRINCIPLED")
        tree.links.new(node.outputs["Color"], shader.inputs["Base Color"])
    return material


def build(paths):
    """A row of planes under a camera and a sun; returns the planes."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    planes = []
    for i, _ in enumerate(paths):
        bpy.ops.mesh.primitive_plane_add(size=0.9, location=(i - (len(paths) - 1) / 2, 0, 0))
        planes.append(bpy.context.object)
    scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.camera.location.z = 1.4 * len(paths)
    lamp = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    for thing in (scene.camera, lamp):
        scene.collection.objects.link(thing)
    return scene, planes


def megabytes_now():
    """Resident memory of this process."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * resource.getpagesize() / 2**20


def megabytes_peak():
    """The most that it has been."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**10


def run_child(options):
    """Renders without and with the textures; reports seconds and megabytes."""
    engines.register(options.child)
    paths = sorted(Path(options.folder).iterdir())
    scene, planes = build(paths)
    engines.choose(scene, options.child, SIZE)
    plain = textured(None)
    # One image of a texel, so that the program that reads images is there as well.
    small = textured(Path(options.folder).parent / "small.png")
    for i, plane in enumerate(planes):
        plane.data.materials.append(small if i == 0 else plain)
    engines.measure(scene)
    base = engines.measure(scene)
    before = megabytes_now()
    for plane, path in zip(planes, paths):
        plane.data.materials[0] = textured(path)
    first = engines.measure(scene)
    peak, kept = megabytes_peak() - before, megabytes_now() - before
    second = engines.measure(scene)
    rest = base if options.child == "CYCLES" else second
    engines.report({"load": first["seconds"] - rest["seconds"], "cpu": first["cpu_seconds"] - rest["cpu_seconds"],
                    "peak": peak, "kept": kept, "base": base, "first": first, "second": second})


# --- the run --------------------------------------------------------------------------------------------------


def main():
    options = parse_options()
    if options.child:
        run_child(options)
        return
    runs = {engine: [] for engine in engines.ENGINES}
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary) / "textures"
        folder.mkdir()
        make_textures(folder, options.count, options.side)
        make_textures(temporary, 1, 1)
        (Path(temporary) / "texture_0.png").rename(Path(temporary) / "small.png")
        for engine in engines.in_turns(options.repeat):
            runs[engine].append(engines.child(__file__, engine, ["--folder", str(folder)]))
    medians = {column: {engine: statistics.median(run[column] for run in runs[engine]) for engine in engines.ENGINES}
               for column in COLUMNS}
    ratios = {column: found["PANOPTES"] / found["CYCLES"] for column, found in medians.items()}
    if options.json:
        print(json.dumps({"count": options.count, "side": options.side, "medians": medians, "ratios": ratios, "runs": runs},
                         indent=1))
        return
    print(f"{options.count} textures of {options.side}x{options.side}, median of {options.repeat}")
    print(f"{'':22}{'Cycles':>10}{'Panoptes':>10}{'ratio':>8}")
    for column, unit in zip(COLUMNS, ("seconds", "seconds", "MiB", "MiB")):
        print(f"{column + ', ' + unit:22}" + "".join(f"{medians[column][engine]:10.2f}" for engine in engines.ENGINES)
              + f"{ratios[column]:8.2f}")


main()
