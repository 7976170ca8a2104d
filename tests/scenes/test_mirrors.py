# SPDX-License-Identifier: GPL-3.0-or-later
"""What mirrors and glass show in Real-time against Cycles: all that their surfaces send to the camera.

The walls are lit by one lamp and by nothing that has bounced, so that nothing but specular paths is compared. Means of
blocks of pixels are, since edges are antialiased by other samples in either engine.
"""

import numpy as np
import pytest

import renders

SIZE, BLOCK = (80, 45), 5
SAMPLES, CYCLES_SAMPLES = 48, 128
# Of the mean light of a pass.
LARGEST_ERROR, LARGEST_BRIGHTNESS_ERROR = 0.04, 0.02
# Of the blocks, by their error. Lamps' highlights in metal that is seen in other metal come by few paths, and are as
# bright as a hundred walls: in either engine a sample decides its block.
JUDGED = 0.95


def blocks(passes, kind):
    """float[H / BLOCK, W / BLOCK, 3] of the light that came by a kind of lobe and had been scattered before."""
    light = (passes[f"{kind}Ind"] * passes[f"{kind}Col"])[..., :3]
    height, width = light.shape[0] // BLOCK, light.shape[1] // BLOCK
    return light.reshape(height, BLOCK, width, BLOCK, 3).mean(axis=(1, 3))


def compared(found, reference):
    """Error and ratio of brightness over the blocks that are judged, both relative to the reference's mean."""
    differences = np.abs(found - reference).max(axis=2)
    judged = differences <= np.quantile(differences, JUDGED)
    scale = reference[judged].mean()
    return np.sqrt(np.mean((found - reference)[judged] ** 2)) / scale, found[judged].mean() / scale


@pytest.mark.slow
def test_mirrors_and_glass_show_what_they_show_in_cycles():
    pictures, _ = renders.render("builder:mirrors", [
        renders.picture("PANOPTES", SAMPLES, method="realtime", bounces=0), renders.picture("CYCLES", CYCLES_SAMPLES, seed=1),
        renders.picture("CYCLES", CYCLES_SAMPLES, seed=2)], size=SIZE)
    for kind in ("Gloss", "Trans"):
        ours, one, another = (blocks(entry, kind) for entry in pictures)
        reference = (one + another) / 2.0
        assert reference.mean() > 0.02
        (error, brightness), (noise, _) = compared(ours, reference), compared(one, reference)
        print(f"{kind}: error {error:.4f}, Cycles' noise {noise:.4f}, brightness {brightness:.4f}, light {reference.mean():.4f}")
        assert noise < 0.5 * LARGEST_ERROR
        assert error < LARGEST_ERROR
        assert abs(brightness - 1.0) < LARGEST_BRIGHTNESS_ERROR
