# SPDX-License-Identifier: GPL-3.0-or-later
"""How far the cache's light is from that of paths: the section error, for each encoding and number of bounces.

Beside what judge.py tells: clipped, the share of the cache's light that is cut off where harmonics ring below 0.
"""

import judge
import light
import plots
import tables

ENCODINGS = ("y3co1cg1", "y3co2cg2", "y3co3cg3", "rgb3", "y2co2cg2", "rgb2")


def measure(path, options):
    """All encodings and numbers of bounces on one scene."""
    scene = light.Light(path, options.pixels)
    colour, rows = scene.colour(), {}
    for bounces in options.bounces:
        paths, cycles = (trace(options.reference_samples, bounces) for trace in (scene.paths, scene.cycles))
        rows[f"paths, {bounces} bounces"] = judge.floor(paths, cycles, colour)
        shown = {"paths": (paths + cycles) / 2.0 * colour}
        for encoding in options.encodings:
            found = scene.diffuse(options.samples, bounces=bounces, encoding=encoding)
            rows[f"{encoding}, {bounces} bounces"] = {**judge.row(found, paths, cycles, colour),
                                                      "clipped": scene.clipped(bounces=bounces, encoding=encoding)}
            shown[light.as_written(encoding)] = found * colour
        plots.strip(options.pictures, f"error_{path.stem}_{bounces}", shown, judge.exposure(shown["paths"]))
    return {"scene": path.stem, "size": scene.size, "rows": rows}


def run(options):
    """Measures and prints; returns what was found."""
    found = []
    for path in light.paths_of(options):
        scene = measure(path, options)
        found.append(scene)
        tables.show(f"error: {scene['scene']}, {scene['size'][0]}x{scene['size'][1]}, {options.samples} samples of the film, references of "
                    f"{options.reference_samples}", scene["rows"], {**judge.FORMATS, "clipped": ".2%"})
    return found
