# SPDX-License-Identifier: GPL-3.0-or-later
"""Traced paths against Cycles' finished pictures, in short; reference_fit.py measures them at length.

The first part needs no Blender. The second renders two pictures of a few samples by other seeds: their difference
tells their noise, and what is left of the error besides must be next to nothing.
"""

import numpy as np
import pytest

import reference_fit
import renders

# Of a pass' mean, by the issue that asked for paths; of its squared error, what a mean of that much would make.
LARGEST_BRIGHTNESS_ERROR = LARGEST_BIAS = 0.01
# How many standard errors may come on top: of a few dozen comparisons none is wrong by chance.
CONFIDENCE = 4.0
# Pixels a side of the blocks that are compared.
BLOCK = 15


def noisy(mean, counts, spread=0.3, bias=0.0):
    """Pictures of so many samples each whose pixels have this spread a sample; float[60, 60, 3]."""
    random = np.random.default_rng(1)
    return [mean + bias + spread / np.sqrt(count) * random.standard_normal((60, 60, 3)) for count in counts]


COUNTS = [1, 2, 4, 8, 16, 32, 64]


@pytest.mark.parametrize("rest", [0.0, 0.05])
def test_fit_finds_what_noise_leaves(rest):
    errors = np.sqrt(0.09 / np.array(COUNTS) + rest**2)
    assert reference_fit.fit(COUNTS, errors) == pytest.approx((0.09, rest), rel=1e-6, abs=1e-9)


def test_fit_of_errors_that_fall_faster_than_noise():
    found = reference_fit.fit(COUNTS, 0.3 / np.array(COUNTS))
    assert found.b == 0.0 and found.a > 0.0


def test_a_pass_without_errors_has_nothing_left():
    assert reference_fit.fit(COUNTS, np.zeros(len(COUNTS))) == (0.0, 0.0)


def test_judging_sees_noise_of_the_reference_and_a_wrong_mean():
    reference = 0.5 + 0.02 * np.random.default_rng(2).standard_normal((60, 60, 3))
    right = reference_fit.judge_pass(COUNTS, noisy(0.5, COUNTS), reference)
    assert right.fit.b == pytest.approx(0.02, rel=0.1) and right.fit.a == pytest.approx(0.09, rel=0.1)
    assert abs(right.ratio - 1.0) < 5.0 * right.ratio_error < 0.01
    wrong = reference_fit.judge_pass(COUNTS, noisy(0.5, COUNTS, bias=0.05), reference)
    assert wrong.ratio == pytest.approx(1.1, abs=0.005) and wrong.fit.b == pytest.approx(0.054, rel=0.1)


def test_blocks_cut_what_is_left_over():
    picture = np.zeros((7, 8, 4))
    picture[:3, 3:6] = 9.0
    found = reference_fit.blocks(picture, 3)
    assert found.shape == (2, 2, 3) and found[0, 1, 0] == 9.0 and found.sum() == 27.0


def test_agreement_tells_bias_from_noise():
    reference = noisy(0.5, [1], spread=0.01)[0]
    for bias in (0.0, 0.02):
        one, another = noisy(0.5, [4, 4], bias=bias)
        found = reference_fit.agreement(one, another, reference, 0.01, 4)
        assert found.noise == pytest.approx(0.15 / np.sqrt(2.0) / 4.0, rel=0.1)
        assert abs(found.bias_squared - bias**2) < 4.0 * found.bias_squared_error < 4e-4
        assert abs(found.ratio - 1.0 - bias / 0.5) < 4.0 * found.ratio_error < 0.02


def light(passes):
    """What can be averaged over pixels: colour is multiplied into what it was divided out of."""
    found = {name: passes[name][..., :3] for name in ("Combined", "DiffCol", "Emit", "Env")}
    for name in ("DiffDir", "DiffInd"):
        found[name] = passes[name][..., :3] * passes["DiffCol"][..., :3]
    return {name: picture for name, picture in found.items() if picture.mean() > reference_fit.DARK}


@pytest.mark.slow
@pytest.mark.parametrize("scene, samples", [("cornell", 8), ("fox_skinned", 4), ("sponza_crytek", 2)])
def test_paths_converge_to_cycles(scene, samples):
    if not renders.SHARED.joinpath("reference", f"{scene}.exr").is_file():
        pytest.skip(f"the reference of {scene} is not at {renders.SHARED}; PANOPTES_SHARED_SCENES can name its folder")
    passes = reference_fit.reference_passes(scene)
    reference = light(passes)
    one, another = map(light, reference_fit.render(scene, [samples, samples], "primitive", passes))
    wrong = []
    for name, wanted in reference.items():
        found = reference_fit.agreement(one[name], another[name], wanted, reference_fit.REFERENCE_NOISE[scene], BLOCK)
        print(f"{scene} {name}: {found}")
        # Where noise hides what is looked for, a test that passes says nothing.
        assert found.ratio_error < LARGEST_BRIGHTNESS_ERROR
        if abs(found.ratio - 1.0) > LARGEST_BRIGHTNESS_ERROR + CONFIDENCE * found.ratio_error:
            wrong.append(f"{name} is {found.ratio:.4f} times as bright (+- {found.ratio_error:.4f})")
        if found.bias_squared > (LARGEST_BIAS * wanted.mean()) ** 2 + CONFIDENCE * found.bias_squared_error:
            wrong.append(f"{name} differs by {np.sqrt(found.bias_squared):.4f} besides its noise of {found.noise:.4f}")
    assert not wrong, "\n" + "\n".join(wrong)
