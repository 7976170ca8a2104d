#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The shared scenes by Panoptes against Cycles' finished pictures, as a table of errors.

    tests/scenes/table.py [SCENE ...] [--samples N] [--passes] [--pictures FOLDER] [--json]

Combined by every metric, or with --passes the relative RMSE of each pass that both have. There is no bar: what a
method leaves out by design shows here as error.
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

SCENES = ("cornell", "veach_mis", "sponza_crytek", "materialball_glass", "foliage_ivy_oak", "igea_deform", "fox_skinned")
COMBINED = ("relative_rmse", "srgb_rmse", "relative_mse", "lab_rmse", "flip")
PASSES = ("DiffCol", "DiffDir", "Normal", "Depth", "Emit", "Env")


def pass_errors(ours, reference):
    """Relative RMSE of each pass; None where the reference is black, or where we have none."""
    found = {}
    for name in PASSES:
        if name not in ours or name not in reference or not np.any(reference[name]):
            found[name] = None
            continue
        channels = reference[name].shape[2]
        test, wanted = ours[name][:, :, :channels], reference[name]
        keep = None
        if name == "Depth":
            # Beyond everything both say 1e10, and an edge may fall to either side: compare what both hit.
            keep = ((test < 1e9) & (wanted < 1e9))[:, :, 0]
        # A normal's mean says nothing; its length is 1, so the plain error is the relative one.
        found[name] = (metrics.rmse if name == "Normal" else metrics.relative_rmse)(test, wanted, keep)
    return found


def judge(name, samples=None, pictures=None):
    """Renders one scene by Panoptes and returns (all metrics of Combined, errors of the passes)."""
    reference = images.read_passes(renders.SHARED / "reference" / f"{name}.exr")
    height, width = reference["Combined"].shape[:2]
    (ours,), _ = renders.render(name, [renders.picture("PANOPTES", samples)], size=(width, height))
    if pictures:
        Path(pictures).mkdir(parents=True, exist_ok=True)
        images.write_exr(Path(pictures) / f"{name}.exr", {key: value for key, value in ours.items() if key in (*PASSES, "Combined")})
        images.write_png(Path(pictures) / f"{name}.png", compare.difference_picture(
            ours["Combined"][:, :, :3], reference["Combined"][:, :, :3], 2.0))
    return metrics.all_metrics(ours["Combined"][:, :, :3], reference["Combined"][:, :, :3]), pass_errors(ours, reference)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", nargs="*", default=list(SCENES), metavar="SCENE")
    parser.add_argument("--samples", type=int, help="of Panoptes; the file's own setting by default")
    parser.add_argument("--passes", action="store_true", help="the relative RMSE of each pass instead (Normal: plain RMSE)")
    parser.add_argument("--pictures", metavar="FOLDER", help="write ours, the reference and the difference")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    if not renders.SHARED.is_dir():
        parser.error(f"there are no shared scenes at {renders.SHARED}; name their folder by PANOPTES_SHARED_SCENES.")
    columns = PASSES if options.passes else COMBINED
    results = {}
    if not options.json:
        print(f"{'scene':20}" + "".join(f"{column:>15}" for column in columns))
    for name in options.scenes:
        combined, passes = judge(name, options.samples, options.pictures)
        results[name] = {**combined, "passes": passes}
        if not options.json:
            row = passes if options.passes else combined
            print(f"{name:20}" + "".join(f"{'-' if row[column] is None else format(row[column], '.4f'):>15}" for column in columns),
                  flush=True)
    if options.json:
        print(json.dumps(results, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main())
