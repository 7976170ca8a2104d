#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lamps alone: Panoptes' Diffuse Direct against Cycles', away from shadow edges.

    tests/scenes/lamps.py [SCENE ...] [--size 480x270] [--samples 128] [--pictures FOLDER] [--json]

Every scene is rendered without its world's light and without glowing surfaces, and with lamps of no size, so
that both engines compute the same number without any sampling: what differs is wrong in one of them.

Which pixels are near a shadow edge is decided by Cycles alone. Each lamp is rendered by itself twice, with its
shadows and without; the quotient is the share of the pixel that the lamp reaches (where it would reach any). A pixel
lies on an edge if that share is strictly between 0 and 1, or if a neighbour's is another; near an edge means at most
two pixels from it, diagonally too. A lamp's shadow through a half-transparent surface is all edge by this rule, so
the share of pixels that remain is part of the result, as is the error with nothing left out.

One more kind of pixel is left out, for Diffuse Direct is light divided by surface: beside what has no diffuse
surface at all (the background, metal), pixels of which diffuse surfaces cover less than half. There the
quotient hangs on single samples, and two renders by Cycles differ as much as black from white.

The floor is the error between two renders by Cycles that differ in the seed: antialiasing alone.
"""

import argparse
import json
import sys
from pathlib import Path

import numpy as np

import renders

import compare  # noqa: E402  (found through renders, which puts the metrics on the path)
import images  # noqa: E402
import metrics  # noqa: E402

SHARED_SCENES = ("sponza_crytek", "foliage_ivy_oak", "igea_deform", "fox_skinned")
# Below half a sample of 64 that just misses a shadow; the same samples are used with shadows and without.
SHARE_TOLERANCE = 0.005
EDGE_DISTANCE_PIXELS = 2
# A pixel as dark as this beside a bright one is background with a few samples of a surface.
EMPTY_SHARE = 0.05


def dilated(mask, pixels):
    """True within `pixels` of a True pixel of bool[H, W], by the larger of the two distances."""
    padded = np.pad(mask, pixels)
    height, width = mask.shape
    return np.any([padded[y:y + height, x:x + width] for y in range(2 * pixels + 1) for x in range(2 * pixels + 1)], axis=0)


def near_shadow_edge(shadowed, unshadowed):
    """The pixels near an edge of one lamp's shadow, bool[H, W], from its Diffuse Direct with and without shadows."""
    shadowed, unshadowed = shadowed.sum(axis=2), unshadowed.sum(axis=2)
    reached = unshadowed > 0.0
    share = np.where(reached, shadowed / np.where(reached, unshadowed, 1.0), 0.0)
    edge = reached & (share > SHARE_TOLERANCE) & (share < 1.0 - SHARE_TOLERANCE)
    for axis in (0, 1):
        # Only pixels that the lamp could reach have a share to compare.
        low, high = (tuple(slice(*part) if a == axis else slice(None) for a in (0, 1)) for part in ((None, -1), (1, None)))
        step = reached[low] & reached[high] & (np.abs(share[low] - share[high]) > SHARE_TOLERANCE)
        edge[low] |= step
        edge[high] |= step
    return dilated(edge, EDGE_DISTANCE_PIXELS)


def mostly_without_diffuse(albedo):
    """The pixels of which diffuse surfaces cover less than half, beside pixels with hardly any.

    albedo: Diffuse Color, float[H, W, 3]. Coverage is judged by the brightest pixel around: at the border of a
    surface with its background, the surface itself. Hardly any is below EMPTY_SHARE of that.
    """
    albedo = albedo.sum(axis=2)
    padded = np.pad(albedo, EDGE_DISTANCE_PIXELS)
    height, width = albedo.shape
    around = np.max([padded[y:y + height, x:x + width] for y in range(2 * EDGE_DISTANCE_PIXELS + 1)
                     for x in range(2 * EDGE_DISTANCE_PIXELS + 1)], axis=0)
    return (albedo < 0.5 * around) & dilated(albedo <= EMPTY_SHARE * around, EDGE_DISTANCE_PIXELS)


def kept_pixels(passes, lamps):
    """The pixels that are compared, bool[H, W], from Cycles' pictures: per lamp with shadows, then without."""
    light = [found["DiffDir"][:, :, :3] for found in passes]
    edges = [near_shadow_edge(light[2 * lamp], light[2 * lamp + 1]) for lamp in range(lamps)]
    return ~(np.any(edges, axis=0) | mostly_without_diffuse(passes[0]["DiffCol"]))


def compare_scene(name, size=(480, 270), samples=128, panoptes_samples=None, pictures=None):
    """Renders and compares one scene.

    Returns a dict: kept (share of pixels), error and error_all (relative RMSE away from edges and everywhere), floor
    (Cycles against itself, away from edges), brightness (mean of Panoptes over Cycles, away from edges).
    """
    _, count = renders.render(name, [], lamps_alone=True, size=size)
    if count == 0:
        raise ValueError(f"{name} has no lamp; there is nothing to compare.")
    wanted = [renders.picture("CYCLES", samples, shadows, 1, lamp) for lamp in range(count) for shadows in (True, False)]
    wanted += [renders.picture("CYCLES", samples, seed=2), renders.picture("PANOPTES", panoptes_samples)]
    passes, _ = renders.render(name, wanted, lamps_alone=True, size=size)
    light = [found["DiffDir"][:, :, :3] for found in passes]
    other_seed, ours = light[-2:]
    # Diffuse Direct is light by itself: that of all lamps is the sum of each lamp's.
    reference = np.sum(light[0:-2:2], axis=0)
    keep = kept_pixels(passes, count)

    if pictures:
        Path(pictures).mkdir(parents=True, exist_ok=True)
        stem = name.replace(":", "-")
        images.write_exr(Path(pictures) / f"{stem}.exr", {
            "Combined": ours, "DiffDir": ours, "Reference": reference, "Keep": keep[..., None].astype(np.float32)})
        gain = 1.0 / max(reference.mean(), 1e-9)
        shown = compare.difference_picture(ours * 0.3 * gain, reference * 0.3 * gain, 4.0)
        unkept = np.repeat(keep[..., None], 3, axis=2) * 0.6
        images.write_png(Path(pictures) / f"{stem}.png", np.concatenate([shown, unkept], axis=1))
    return {"kept": float(keep.mean()), "error": metrics.relative_rmse(ours, reference, keep),
            "error_all": metrics.relative_rmse(ours, reference), "floor": metrics.relative_rmse(other_seed, reference, keep),
            "brightness": float(ours[keep].mean() / reference[keep].mean())}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", nargs="*", default=list(SHARED_SCENES), metavar="SCENE",
                        help="a shared scene, one of blend_scenes, or builder:NAME for one of builders.py")
    parser.add_argument("--size", default="480x270")
    parser.add_argument("--samples", type=int, default=128, help="of Cycles")
    parser.add_argument("--panoptes-samples", type=int, help="of Panoptes; the file's own setting by default")
    parser.add_argument("--pictures", metavar="FOLDER", help="write ours, Cycles', the difference and the kept pixels")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    size = tuple(int(part) for part in options.size.split("x"))
    results = {}
    if not options.json:
        print(f"{'scene':22} {'kept':>6} {'error':>8} {'with edges':>11} {'floor':>8} {'brightness':>11}")
    for name in options.scenes:
        found = results[name] = compare_scene(name, size, options.samples, options.panoptes_samples, options.pictures)
        if not options.json:
            print(f"{name:22} {found['kept']:6.1%} {found['error']:8.2%} {found['error_all']:11.2%} "
                  f"{found['floor']:8.2%} {found['brightness']:11.4f}", flush=True)
    if options.json:
        print(json.dumps(results, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main())
