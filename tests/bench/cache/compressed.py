# SPDX-License-Identifier: GPL-3.0-or-later
"""What encodings of the cache's light lose, as tables and as pictures: Figures 5.8 and 5.11, of the section speed.

Each is compared with the encoding that keeps most, of the same cells; as for all pictures of light from the cache, that
is DiffInd times colour.
"""

import judge
import light
import metrics
import numpy as np
import plots
import tables

# Of Figure 5.8, ever less chrominance; of Figure 5.11, 11 coefficients, 12 and 12; and what they are measured against, 27.
LESS_CHROMINANCE, BALANCED, UNCOMPRESSED = ("y3co3cg3", "y3co2cg2", "y3co1cg1"), ("y3co1cg1", "y2co2cg2", "rgb2"), "rgb3"
BOUNCES = 2
# Weights of red, green and blue in the luminance that the encodings keep apart (equation 5.6).
LUMINANCE = np.array([0.25, 0.5, 0.25])


def row(picture, whole):
    """One line of the table: an encoding's picture against that of the one that keeps most."""
    luminances = ((shown @ LUMINANCE)[:, :, None] for shown in (picture, whole))
    return {"rmse": metrics.relative_rmse(picture, whole), "luminance rmse": metrics.relative_rmse(*luminances), **judge.look(picture, whole)}


def compare(options, figure, scenes, encodings):
    """Table and pictures of one figure; {scene: {encoding: row}}."""
    found = {}
    for path in light.paths_of(options, scenes):
        scene = light.Light(path, options.pixels)
        colour = scene.colour()
        shown = {encoding: scene.diffuse(options.samples, bounces=BOUNCES, encoding=encoding) * colour for encoding in (UNCOMPRESSED, *encodings)}
        whole = shown[UNCOMPRESSED]
        found[path.stem] = {encoding: row(shown[encoding], whole) for encoding in encodings}
        tables.show(f"Figure {figure}: {path.stem}, against {UNCOMPRESSED} of the same cache", found[path.stem],
                    {"rmse": ".4f", "luminance rmse": ".4f", "flip": ".4f", "lab": ".3f", "seen": ".2%"})
        plots.strip(options.pictures, f"figure_{figure.replace('.', '_')}_{path.stem}",
                    {light.as_written(encoding): picture for encoding, picture in shown.items()}, judge.exposure(whole))
    return found


def figure_5_8(options):
    """Ever less chrominance, where light of two colours comes from opposite sides."""
    return compare(options, "5.8", ("two_spots",), LESS_CHROMINANCE)


def figure_5_11(options):
    """Encodings of about the same size: more bands of luminance, or as many of each."""
    return compare(options, "5.11", ("two_spots", "canyon", "sponza_crytek"), BALANCED)
