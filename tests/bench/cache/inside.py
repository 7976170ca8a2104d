# SPDX-License-Identifier: GPL-3.0-or-later
"""What is inside the cache: the section inside, its debug pictures on one scene, and how bright each is."""

import light
import numpy as np
import plots
import stage
import tables

# By settings['cache']['picture'] of a request.
PICTURES = {"geometry": "voxels", "occupancy": "cells", "lobes": "light by direction", "light": "light of the cells", "clipped": "clipped light"}


def run(options):
    """Renders and prints; returns what was found."""
    scene = light.Light(options.scene or stage.our_scene("atrium"), options.pixels)
    shown = {name: scene.take("realtime", ("Combined",), options.samples, cache={"picture": name}).passes["Combined"][:, :, :3].astype(np.float64)
             for name in PICTURES}
    rows = {name: {"mean": float(picture.mean()), "largest": float(picture.max())} for name, picture in shown.items()}
    tables.show(f"inside: {scene.path.stem}, {scene.size[0]}x{scene.size[1]}, {options.samples} samples of the film; brightness", rows,
                {"mean": ".4f", "largest": ".4f"})
    plots.strip(options.pictures, f"inside_{scene.path.stem}", {PICTURES[name]: picture for name, picture in shown.items()})
    return {"scene": scene.path.stem, "rows": rows}
