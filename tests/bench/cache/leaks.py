# SPDX-License-Identifier: GPL-3.0-or-later
"""What does not pass thin walls: the section leaks.

Beside each other are cells that light both sides of a wall, as in the dissertation, and cells that count for what their
seeds see; and paths. Look at the pictures, too: what has leaked is little of the whole light and much of a dark room's.
"""

import judge
import light
import plots
import tables

SCENES = ("doorway",)
BOUNCES = 2
WALLS = {"both sides": False, "what seeds see": True}


def run(options):
    """Measures and prints; returns what was found."""
    found = {}
    for path in light.paths_of(options, SCENES):
        scene = light.Light(path, options.pixels)
        colour = scene.colour()
        paths, cycles = (trace(options.reference_samples, BOUNCES) for trace in (scene.paths, scene.cycles))
        cached = {name: scene.diffuse(options.samples, bounces=BOUNCES, walls=walls) for name, walls in WALLS.items()}
        rows = found[path.stem] = {name: judge.row(picture, paths, cycles, colour) for name, picture in cached.items()}
        shown = {name: picture * colour for name, picture in {"paths": (paths + cycles) / 2.0, **cached}.items()}
        plots.strip(options.pictures, f"leaks_{path.stem}", shown, judge.exposure(shown["paths"]))
        tables.show(f"leaks: {path.stem}, {scene.size[0]}x{scene.size[1]}, {BOUNCES} bounces, {options.samples} samples of the film, references of "
                    f"{options.reference_samples}", rows, judge.FORMATS)
    return found
