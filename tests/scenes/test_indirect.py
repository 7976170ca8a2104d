# SPDX-License-Identifier: GPL-3.0-or-later
"""Light that bounced, from the cache of Real-time, against Cycles' Diffuse Indirect; `panoptes bench cache` measures it at length.

Compared is what arrives at the camera, DiffInd times DiffCol, as means of blocks of pixels, since edges are antialiased
by other samples in either engine.
"""

import numpy as np
import pytest

import renders

BOUNCES, BLOCK = 2, 9
# Of the reference's energy, by the issue that asked for the cache.
LARGEST_BRIGHTNESS_ERROR = 0.1


def blocks(passes):
    """float[H / BLOCK, W / BLOCK, 3] of the light that bounced."""
    light = (passes["DiffInd"] * passes["DiffCol"])[..., :3]
    height, width = light.shape[0] // BLOCK, light.shape[1] // BLOCK
    return light[:height * BLOCK, :width * BLOCK].reshape(height, BLOCK, width, BLOCK, 3).mean(axis=(1, 3))


def relative(difference, reference):
    """RMSE over the reference's mean."""
    return np.sqrt(np.mean(difference**2)) / reference.mean()


@pytest.mark.slow
@pytest.mark.parametrize("name, size, cycles_samples, largest_error", [("cornell", (54, 54), 256, 0.12), ("doorway", (72, 45), 1024, 0.3)])
def test_bounced_light_is_that_of_cycles(name, size, cycles_samples, largest_error):
    if name == "cornell" and not renders.SHARED.joinpath("cornell.blend").is_file():
        pytest.skip(f"cornell is not at {renders.SHARED}; PANOPTES_SHARED_SCENES can name its folder")
    pictures, _ = renders.render(name, [
        renders.picture("PANOPTES", 8, method="realtime", bounces=BOUNCES),
        renders.picture("CYCLES", cycles_samples, seed=1, bounces=BOUNCES),
        renders.picture("CYCLES", cycles_samples, seed=2, bounces=BOUNCES)], size=size)
    ours, one, another = map(blocks, pictures)
    reference = (one + another) / 2.0
    error, noise = relative(ours - reference, reference), relative(one - reference, reference)
    brightness = ours.mean() / reference.mean()
    print(f"{name}: error {error:.4f}, Cycles' noise {noise:.4f}, brightness {brightness:.4f}")
    # Where noise hides what is looked for, a test that passes says nothing.
    assert noise < 0.25 * largest_error
    assert error < largest_error
    assert abs(brightness - 1.0) < LARGEST_BRIGHTNESS_ERROR
