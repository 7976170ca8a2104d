# SPDX-License-Identifier: GPL-3.0-or-later
"""How much the cache's light flickers while a lamp and the camera move slowly: the section stability.

Compared are frames that follow each other. What the scene itself changes is told by paths of the same frames, whose
random numbers are the same in each, so that their noise changes little. Of the picture and of blocks of it:

    flicker = | ours' change / ours' mean - paths' change / paths' mean |

of DiffInd times colour, the means over the whole picture and all frames. No share of earlier frames is blended in.
"""

import judge
import light
import numpy as np
import tables

SCENES = ("canyon", "two_spots", "doorway")
# Blocks that a picture is cut into, across and down.
BLOCKS = (8, 5)
BOUNCES = 2
MOVING = {"lamp and camera": (True, True), "lamp": (True, False), "camera": (False, True)}


def block_means(picture):
    """float64[down * across] of float[H, W, C]."""
    return np.array([block.mean() for row in np.array_split(picture, BLOCKS[1], axis=0) for block in np.array_split(row, BLOCKS[0], axis=1)])


def freeze(scene, lamp, camera):
    """Stops the lamp or the camera, unless they shall move."""
    for made in scene.objects:
        if made.animation_data and not {"LIGHT": lamp, "CAMERA": camera}.get(made.type, True):
            made.animation_data_clear()


def flicker(ours, paths):
    """(largest, mean) change of ours beyond that of paths, float64[frames, ...] each, relative to the means."""
    changes = (np.diff(pictures, axis=0) / pictures.mean() for pictures in (ours, paths))
    beyond = np.abs(next(changes) - next(changes))
    return float(beyond.max()), float(beyond.mean())


def measure(path, moving, options):
    """Flicker of one scene with the things that move."""
    scene = light.Light(path, options.pixels)
    freeze(scene.scene, *MOVING[moving])
    first = scene.scene.frame_start
    ours, paths = [], []
    for frame in range(first, first + options.frames):
        scene.scene.frame_set(frame)
        colour = scene.colour()
        ours.append(block_means(scene.diffuse(options.samples, bounces=BOUNCES) * colour))
        paths.append(block_means(scene.paths(options.flicker_samples, BOUNCES, moving) * colour))
    ours, paths = np.array(ours), np.array(paths)
    row = {}
    for name, pictures in (("frame", [values.mean(axis=1, keepdims=True) for values in (ours, paths)]), ("block", [ours, paths])):
        row[f"{name} largest"], row[f"{name} mean"] = flicker(*pictures)
    row["paths change"] = float(np.abs(np.diff(paths.mean(axis=1))).max() / paths.mean())
    row["energy"] = judge.ratio(ours, paths)
    return row


def run(options):
    """Measures and prints; returns what was found."""
    found = {}
    for path in light.paths_of(options, SCENES):
        rows = found[path.stem] = {moving: measure(path, moving, options) for moving in MOVING}
        tables.show(f"stability: {path.stem}, {options.size}, {options.frames} frames, {options.samples} samples of the film, paths of "
                    f"{options.flicker_samples}; changes between frames relative to the mean", rows,
                    {"frame largest": ".2%", "frame mean": ".2%", "block largest": ".2%", "block mean": ".2%", "paths change": ".2%", "energy": ".3f"})
    return found
