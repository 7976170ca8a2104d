#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes alone: what Panoptes shows of each node against Cycles, as a table with one line a node.

    tests/scenes/nodes.py [GROUP ...] [--samples N] [--worst] [--pictures FOLDER]

Groups: those of node_cases.GROUPS. A tile of node_atlas.py is compared without its border, as values
(the light turned back into the number) or as light. Errors are relative to the tile's root mean square in Cycles; of a
row with several tiles the worst is shown. --worst names the tile.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

import node_cases
import renders

import images  # noqa: E402  (found through renders, which puts the metrics on the path)

# Below this a number counts by its absolute error.
SMALLEST = 0.05


def tile(picture, index, count):
    """The inner pixels of a tile, float[N, N, 3]; pictures have row 0 at the top."""
    side, pixels = node_cases.side(count), node_cases.PIXELS
    column, row = index % side, side - 1 - index // side
    found = picture[row * pixels:(row + 1) * pixels, column * pixels:(column + 1) * pixels, :3].astype(np.float64)
    return found[1:-1, 1:-1]


def errors(ours, theirs, values):
    """(relative RMSE, largest error of a pixel) of a tile."""
    if values:
        ours, theirs = ((found - node_cases.OFFSET) / node_cases.SCALE for found in (ours, theirs))
        # Negative light is not shown.
        seen = theirs > -0.99 * node_cases.OFFSET / node_cases.SCALE
        if not seen.any():
            return float("nan"), float("nan")
        ours, theirs = ours[seen], theirs[seen]
    scale = max(np.sqrt(np.mean(theirs**2)), SMALLEST)
    difference = np.abs(ours - theirs) / scale
    return float(np.sqrt(np.mean(difference**2))), float(difference.max())


def compare(group, samples=None, pictures=None):
    """Renders a group with both engines; returns {row: (relative RMSE, largest, name of the worst tile)}."""
    light, cases = node_cases.GROUPS[group], node_cases.cases(group)
    wanted = [renders.picture("CYCLES", samples or light.samples, shadows=False),
              renders.picture("PANOPTES", light.panoptes_samples, shadows=False)]
    (reference, ours), _ = renders.render(f"nodes:{group}", wanted)
    reference, ours = reference["Combined"], ours["Combined"]
    if pictures:
        Path(pictures).mkdir(parents=True, exist_ok=True)
        images.write_png(Path(pictures) / f"{group}.png", np.concatenate([ours, reference], axis=1)[..., :3])
    rows = {}
    for index, case in enumerate(cases):
        found = errors(tile(ours, index, len(cases)), tile(reference, index, len(cases)), light.values)
        if case.row not in rows or not found[0] <= rows[case.row][0]:
            rows[case.row] = (*found, case.name)
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("groups", nargs="*", default=list(node_cases.GROUPS), metavar="GROUP")
    parser.add_argument("--samples", type=int, help="of Cycles")
    parser.add_argument("--worst", action="store_true", help="name the worst tile of each row")
    parser.add_argument("--pictures", metavar="FOLDER", help="write ours beside Cycles'")
    options = parser.parse_args()
    for group in options.groups:
        print(f"{group:28} {'rmse':>10} {'largest':>10} {'bound':>8}")
        for row, (rmse, largest, name) in compare(group, options.samples, options.pictures).items():
            bound = node_cases.bound(group, row)
            flag = " " if rmse <= bound.rmse and largest <= bound.largest else "*"
            print(f"{flag}{row:27} {rmse:10.2e} {largest:10.2e} {bound.rmse:8.0e}  {name if options.worst else bound.reason}",
                  flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
