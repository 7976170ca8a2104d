# SPDX-License-Identifier: GPL-3.0-or-later
"""What fragment tracing loses beside primitive tracing, and what it costs; a measurement, never a test.

    ./panoptes bench fragments [--size 240x135] [--scene FILE.blend] [--samples 16] [--reference 256] [--pictures FOLDER] [--json]

All variants follow the same paths with as many samples (thesis, Figures 6.7 to 6.9 and 7.7):

    energy    mean of all light, of that by primitives
    bounced   the same of bounced diffuse light
    AO        mean of the ambient occlusion pass, 1 where nothing is near
    apart     relative RMSE from the same paths by primitives: what fragments do to the picture
    error     relative RMSE from the picture reference/NAME.exr beside the scene where there is one of that size, else
              from --reference samples by primitives
    build ms, trace ms
"""

import argparse
import json
import sys
import tempfile
from pathlib import Path

import bpy

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[1] / "metrics")]
import engines  # noqa: E402
import images  # noqa: E402
import metrics  # noqa: E402
import plots  # noqa: E402
import tables  # noqa: E402

BOUNCES = 2
REFERENCE_SEED = 1000
# Settings of scene.panoptes.fragment by what the tables call them. With a bounded number of layers there are no buckets.
VARIANTS = {
    "one view, one layer": {"views": "CAMERA", "storage": "DLL", "layers": 1},
    "one view, all layers": {"views": "CAMERA"},
    "all views, one layer": {"storage": "DLL", "layers": 1},
    "all views, four layers": {"storage": "DLL", "layers": 4},
    "all": {},
    "all, cube of 512": {"side": 512},
    "by depth, thickness .002": {"by_plane": False, "thickness": 0.002},
    "by depth, thickness .02": {"by_plane": False, "thickness": 0.02},
    "by depth, thickness .1": {"by_plane": False, "thickness": 0.1},
    "32 steps a view": {"walk": "STEPS"},
}
# Which are side by side in pictures, and what they show.
STRIPS = {
    "views": ("Combined", ("primitives", *list(VARIANTS)[:6])),
    "occlusion": ("AO", ("primitives", *list(VARIANTS)[:6])),
    "thickness": ("Combined", ("primitives", "all", *list(VARIANTS)[6:])),
}


def parse_options():
    parser = argparse.ArgumentParser(prog="panoptes bench fragments", description=__doc__.splitlines()[0])
    parser.add_argument("--size", default="240x135", help="width x height in pixels")
    parser.add_argument("--scene", help="a .blend; Sponza beside the checkout if there is one, else our atrium")
    parser.add_argument("--samples", type=int, default=16, help="of each picture")
    parser.add_argument("--reference", dest="repeat", type=int, default=256, help="samples of the finished picture, where none is there")
    parser.add_argument("--variant", action="append", choices=sorted(VARIANTS), help="one of them; may be repeated")
    parser.add_argument("--pictures", metavar="FOLDER", type=Path, help="write them side by side as PNG")
    parser.add_argument("--json", action="store_true", help="print every measurement as JSON")
    options = parser.parse_args(engines.own_arguments())
    engines.complete(parser, options)
    if options.pictures and not options.pictures.is_dir():
        parser.error(f"there is no folder {options.pictures}.")
    return options


def render(scene, samples, path, method, variant):
    """Renders and returns the passes by name, float[H, W, C], and the statistics."""
    engines.choose_paths(scene, samples, BOUNCES)
    scene.panoptes.method = method
    settings = scene.panoptes.fragment
    for name in settings.bl_rna.properties.keys():
        settings.property_unset(name)
    for name, value in variant.items():
        setattr(settings, name, value)
    bpy.ops.render.render()
    engines.save_passes(scene, path)
    passes = {name: images.read_pass(path, name)[..., :3] for name in ("Combined", "DiffInd", "AO")}
    return passes, json.loads(scene.panoptes.last_stats)


def finished(scene, options, folder):
    """Returns the finished picture, float[H, W, 3], and where it is from."""
    path = Path(options.scene).parent / "reference" / f"{Path(options.scene).stem}.exr"
    if path.is_file():
        picture = images.read_pass(path)[..., :3]
        if picture.shape[:2] == (options.height, options.width):
            return picture, "Cycles"
    scene.panoptes.seed = REFERENCE_SEED
    passes, _ = render(scene, options.repeat, folder / "reference.exr", "primitive", {})
    scene.panoptes.seed = 0
    return passes["Combined"], f"{options.repeat} samples by primitives"


def energy(passes, exact, name):
    whole = float(exact[name].mean())
    return float(passes[name].mean()) / whole if whole > 0.0 else None


def measure(scene, options, reference, folder):
    rows, pictures, exact = {}, {}, None
    chosen = {name: VARIANTS[name] for name in options.variant or VARIANTS}
    for name, variant in {"primitives": None, **chosen}.items():
        passes, stats = render(scene, options.samples, folder / "picture.exr",
                               "primitive" if variant is None else "fragment", variant or {})
        exact = exact or passes
        picture = passes["Combined"]
        rows[name] = {"energy": energy(passes, exact, "Combined"), "bounced": energy(passes, exact, "DiffInd"),
                      "AO": float(passes["AO"].mean()), "apart": metrics.relative_rmse(picture, exact["Combined"]),
                      "error": metrics.relative_rmse(picture, reference), "build ms": stats["build_ms"],
                      "trace ms": stats["trace_ms"]}
        pictures[name] = passes
    for strip, (entry, names) in STRIPS.items():
        # Files have rows from the top, strips take them from the bottom.
        shown = {name: pictures[name][entry][::-1] for name in names if name in pictures}
        plots.strip(options.pictures, f"{strip}_{Path(options.scene).stem}", shown)
    return rows


def main():
    options = parse_options()
    engines.register("PANOPTES")
    bpy.ops.wm.open_mainfile(filepath=options.scene)
    scene = bpy.context.scene
    engines.choose(scene, "PANOPTES", (options.width, options.height))
    layer = bpy.context.view_layer
    layer.use_pass_diffuse_indirect = layer.use_pass_ambient_occlusion = True
    with tempfile.TemporaryDirectory() as folder:
        reference, source = finished(scene, options, Path(folder))
        rows = measure(scene, options, reference, Path(folder))
    if options.json:
        print(json.dumps({"fragments": rows}))
        return
    tables.show(f"fragments: {Path(options.scene).stem}, {options.size}, {options.samples} samples, error from {source}", rows,
                {"energy": ".3f", "bounced": ".3f", "AO": ".3f", "apart": ".3f", "error": ".3f", "build ms": ".0f", "trace ms": ".0f"})


main()
