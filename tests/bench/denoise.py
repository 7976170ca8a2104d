# SPDX-License-Identifier: GPL-3.0-or-later
"""What the denoiser makes of paths, and what it costs; a measurement, never a test.

    ./panoptes bench denoise [--size 480x270] [--scene FILE.blend] [--samples 2,8,32] [--denoiser EDGE_AVOIDING] [--json]
    blender -b --factory-startup -P tests/bench/denoise.py -- [the same options]

Each number of samples is rendered once. The noisy picture and the denoised one of the same samples are compared with the
finished picture reference/NAME.exr beside the scene, where there is one of that size, else with one of --reference samples:

    rmse      relative, linear: noisy, denoised
    srgb      of the colours on the screen: noisy, denoised
    worth     so many samples would be as near on the screen without it: samples times the square of the quotient
    ms        of the denoiser; a sample (tracing, of one)
    estimate  of the relative error, by the engine itself
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

BOUNCES = 8  # what the finished pictures were made with
REFERENCE_SEED = 1000


def counts(text):
    return [int(part) for part in text.split(",")]


def parse_options():
    parser = argparse.ArgumentParser(prog="panoptes bench denoise", description=__doc__.splitlines()[0])
    parser.add_argument("--size", default="480x270", help="width x height in pixels")
    parser.add_argument("--scene", help="a .blend; Sponza beside the checkout if there is one, else our atrium")
    parser.add_argument("--samples", type=counts, default=[2, 8, 32], help="of each picture, with commas between them")
    parser.add_argument("--denoiser", choices=("EDGE_AVOIDING", "OIDN", "AUTO"), default="EDGE_AVOIDING")
    parser.add_argument("--reference", type=int, default=1024, help="samples of the finished picture, where none is there")
    parser.add_argument("--json", action="store_true", help="print every measurement as JSON")
    options = parser.parse_args(engines.own_arguments())
    numbers, options.samples, options.repeat = options.samples, min(options.samples), options.reference
    engines.complete(parser, options)
    options.samples = numbers
    if min(numbers) < 2:
        parser.error("one sample does not tell its noise: the least is 2.")
    return options


def render(scene, samples, path):
    engines.choose_paths(scene, samples, BOUNCES)
    bpy.ops.render.render()
    engines.save_passes(scene, path)
    return json.loads(scene.panoptes.last_stats)


def finished(scene, options, folder):
    """Returns the finished picture, float[H, W, C], and where it is from."""
    path = Path(options.scene).parent / "reference" / f"{Path(options.scene).stem}.exr"
    if path.is_file():
        picture = images.read_pass(path)
        if picture.shape[:2] == (options.height, options.width):
            return picture, "Cycles"
    scene.panoptes.denoise.final, scene.panoptes.seed = False, REFERENCE_SEED
    render(scene, options.reference, folder / "reference.exr")
    scene.panoptes.seed = 0
    return images.read_pass(folder / "reference.exr"), f"{options.reference} samples"


def measure(scene, samples, reference, folder):
    stats = render(scene, samples, folder / "picture.exr")
    row = {"samples": samples, "estimate": stats["estimated_error"], "sample_ms": stats["trace_ms"] / samples,
           "warnings": stats["warnings"],
           "denoiser_ms": next(effect["ms"] for effect in stats["effects"] if effect["name"] == "denoiser")}
    for name, entry in (("noisy", "Noisy Image"), ("denoised", "Combined")):
        picture = images.read_pass(folder / "picture.exr", entry)[..., :3]
        row[f"{name}_rmse"] = metrics.relative_rmse(picture, reference)
        row[f"{name}_srgb"] = metrics.srgb_rmse(picture, reference)
    row["worth"] = samples * (row["noisy_srgb"] / row["denoised_srgb"]) ** 2
    return row


def main():
    options = parse_options()
    engines.register("PANOPTES")
    bpy.ops.wm.open_mainfile(filepath=options.scene)
    scene = bpy.context.scene
    engines.choose(scene, "PANOPTES", (options.width, options.height))
    with tempfile.TemporaryDirectory() as folder:
        reference, source = finished(scene, options, Path(folder))
        reference = reference[..., :3]
        scene.panoptes.denoise.final, scene.panoptes.denoise.denoiser = True, options.denoiser
        bpy.context.view_layer.panoptes.use_pass_noisy_image = True
        rows = [measure(scene, samples, reference, Path(folder)) for samples in options.samples]
    if options.json:
        print(json.dumps({"denoise": rows}))
        return
    print(f"denoiser: {Path(options.scene).stem}, {options.size}, against {source}")
    print(f"{'samples':>8}{'rmse':>16}{'srgb':>16}{'worth':>8}{'ms':>8}{'a sample':>10}{'estimate':>10}")
    for row in rows:
        pairs = "".join(f"{row[f'noisy_{key}']:>8.4f}{row[f'denoised_{key}']:>8.4f}" for key in ("rmse", "srgb"))
        print(f"{row['samples']:>8}{pairs}{row['worth']:>8.0f}{row['denoiser_ms']:>8.0f}{row['sample_ms']:>10.0f}"
              f"{row['estimate']:>10.3f}")
    for sentence in dict.fromkeys(sentence for row in rows for sentence in row["warnings"]):
        print(sentence)


if __name__ == "__main__":
    main()
