# SPDX-License-Identifier: GPL-3.0-or-later
"""The metrics against values known from their definitions; run by the system's Python."""

import json
import math

import numpy as np
import pytest

import compare
import flip
import images
import metrics


def picture(value, size=(24, 32)):
    """A picture of one colour."""
    return np.broadcast_to(np.asarray(value, np.float64), (*size, 3)).copy()


def textured(seed=1, size=(48, 64)):
    """Smooth random colours in 0..1, the same for the same seed."""
    coarse = np.random.default_rng(seed).random((size[0] // 8, size[1] // 8, 3))
    return np.repeat(np.repeat(coarse, 8, axis=0), 8, axis=1)


# --- errors in linear and encoded light -----------------------------------------------------------------


def test_identical_pictures_have_no_error():
    noise = textured() * 3.0
    assert all(value == 0.0 for value in metrics.all_metrics(noise, noise.copy()).values())


def test_relative_rmse_is_the_error_over_the_mean():
    reference = picture((1.0, 2.0, 3.0))
    assert metrics.rmse(reference + 0.1, reference) == pytest.approx(0.1, rel=1e-12)
    assert metrics.relative_rmse(reference + 0.1, reference) == pytest.approx(0.05, rel=1e-12)
    # Brightness cancels: the same relative error at any exposure.
    assert metrics.relative_rmse(7 * reference + 0.7, 7 * reference) == pytest.approx(0.05, rel=1e-12)


def test_one_wrong_pixel_counts_by_its_share():
    reference = picture(1.0)
    test = reference.copy()
    test[3, 4] = 2.0
    assert metrics.relative_rmse(test, reference) == pytest.approx(1 / math.sqrt(24 * 32))


def test_relative_rmse_of_a_black_reference():
    assert metrics.relative_rmse(picture(0.0), picture(0.0)) == 0.0
    assert metrics.relative_rmse(picture(0.1), picture(0.0)) == math.inf


def test_srgb_rmse_clamps_and_encodes():
    assert metrics.srgb_rmse(picture(9.0), picture(1.0)) == 0.0
    assert metrics.srgb_rmse(picture(-1.0), picture(0.0)) == 0.0
    # 8-bit 188 is the middle of linear light: the curve takes .5 to .735357.
    assert metrics.srgb_rmse(picture(0.5), picture(0.0)) == pytest.approx(0.735357, abs=1e-6)
    assert metrics.srgb_rmse(picture(0.002), picture(0.0)) == pytest.approx(12.92 * 0.002)


def test_the_srgb_curve_and_its_inverse():
    values = np.linspace(0, 1, 1001)
    # The standard's two rounded thresholds leave a gap of 1e-7 between the branches.
    assert np.abs(images.srgb_to_linear(images.linear_to_srgb(values)) - values).max() < 1e-6


def test_relative_mse_with_its_stated_epsilon():
    assert metrics.relative_mse(picture(0.3), picture(0.2)) == pytest.approx(0.01 / (0.04 + 0.01))
    assert metrics.relative_mse(picture(0.1), picture(0.0)) == pytest.approx(1.0)
    assert metrics.relative_mse(picture(0.1), picture(0.0), epsilon=0.1) == pytest.approx(0.1)


def test_lab_rmse_of_known_colours():
    assert metrics.lab_rmse(picture(1.0), picture(0.0)) == pytest.approx(100.0, abs=1e-9)
    # CIE L*a*b* of the sRGB primaries under D65: red 53.24 80.09 67.20, green 87.73 -86.18 83.18.
    red, green = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)
    assert flip.linear_to_lab(np.array(red)) == pytest.approx((53.24, 80.09, 67.20), abs=0.03)
    assert flip.linear_to_lab(np.array(green)) == pytest.approx((87.73, -86.18, 83.18), abs=0.03)
    assert metrics.lab_rmse(picture(red), picture(green)) == pytest.approx(
        math.sqrt(34.49**2 + 166.27**2 + 15.98**2), abs=0.05)


# --- what cannot be compared ----------------------------------------------------------------------------


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_a_pixel_that_is_not_finite_is_refused(value):
    good, bad = picture(1.0), picture(1.0)
    bad[5, 6, 1] = value
    for pair in ((bad, good), (good, bad)):
        for metric in (metrics.rmse, metrics.relative_rmse, metrics.srgb_rmse, metrics.relative_mse,
                       metrics.lab_rmse, metrics.flip):
            with pytest.raises(ValueError, match="1 pixels of the"):
                metric(*pair)


def test_other_sizes_and_empty_masks_are_refused():
    with pytest.raises(ValueError, match="differ in size"):
        metrics.rmse(picture(1.0), picture(1.0, (24, 33)))
    with pytest.raises(ValueError, match="keeps no pixel"):
        metrics.rmse(picture(1.0), picture(1.0), np.zeros((24, 32), bool))
    with pytest.raises(ValueError, match="mask's size"):
        metrics.rmse(picture(1.0), picture(1.0), np.ones((2, 2), bool))


def test_a_mask_leaves_out_what_it_does_not_keep():
    reference, test = picture(1.0), picture(1.0)
    test[:12] = 5.0
    mask = np.zeros((24, 32), bool)
    mask[12:] = True
    assert metrics.relative_rmse(test, reference, mask) == 0.0
    assert metrics.relative_rmse(test, reference, ~mask) == pytest.approx(4.0)


# --- FLIP -----------------------------------------------------------------------------------------------


def test_the_normalisation_constant_is_green_against_blue():
    # By hand from the primaries' L*a*b*: HyAB = |87.735 - 32.297| + hypot(101.19, 107.81) = 203.3; 203.3^.7 = 41.27.
    assert flip.largest_colour_difference() == pytest.approx(41.27, abs=0.02)
    # And no other pair of the cube's corners is further apart, so that the map stays within 0..1.
    corners = np.array([[r, g, b] for r in (0.0, 1.0) for g in (0.0, 1.0) for b in (0.0, 1.0)])
    lab = flip.hunt_adjusted(flip.linear_to_lab(corners))
    assert (flip.hyab(lab[:, None], lab[None]) ** 0.7).max() == pytest.approx(flip.largest_colour_difference())


def test_green_against_blue_is_the_largest_error():
    assert metrics.flip(picture((0, 1, 0)), picture((0, 0, 1))) == pytest.approx(1.0, abs=1e-9)


def test_black_against_white_is_near_the_largest_error():
    # 100^.7 = 25.119 lies above the knee .4 * 41.27: .95 + (25.119 - 16.508) / (41.27 - 16.508) * .05 = .9674.
    assert metrics.flip(picture(0.0), picture(1.0)) == pytest.approx(0.9674, abs=2e-4)


def test_uniform_greys_follow_the_linear_part():
    # Lightness of linear .2 and .25: 51.837 and 57.075. 5.238^.7 * .95 / 16.508.
    assert metrics.flip(picture(0.2), picture(0.25)) == pytest.approx(5.238**0.7 * 0.95 / 16.508, abs=2e-4)


def test_flip_is_symmetric_and_within_bounds():
    one, other = textured(1), textured(2)
    forth, back = flip.flip(one, other), flip.flip(other, one)
    assert np.array_equal(forth, back)
    assert forth.min() >= 0.0 and forth.max() <= 1.0 and forth.mean() > 0.1


def test_flip_ignores_what_a_screen_cannot_show():
    one = textured()
    one[:8] = 1.0
    brighter = one.copy()
    brighter[:8] = 20.0
    assert metrics.flip(brighter, one) == 0.0


def test_a_shifted_edge_is_seen_where_it_was_and_is():
    reference, test = picture(0.2, (64, 96)), picture(0.2, (64, 96))
    reference[:, 48:] = 0.6
    test[:, 51:] = 0.6
    errors = flip.flip(test, reference)
    assert errors[:, 49].min() > 0.4
    assert errors[:, :20].max() < 1e-6 and errors[:, 80:].max() < 1e-6
    # The further the shift the larger the error.
    further = picture(0.2, (64, 96))
    further[:, 57:] = 0.6
    assert flip.flip(further, reference).mean() > 1.5 * errors.mean()


def test_the_feature_term_raises_the_error_at_edges():
    # The same difference of colour, once as an area and once as a thin line, which the colour filter blurs.
    reference = picture(0.3, (64, 96))
    line = reference.copy()
    line[:, 48] = 0.8
    errors = flip.flip(line, reference)
    opponents = [flip.linear_to_opponent(image) for image in (line, reference)]
    seen = [flip.hunt_adjusted(flip.linear_to_lab(flip.opponent_to_linear(
        flip.sensitivity_filtered(opponent, flip.PIXELS_PER_DEGREE)))) for opponent in opponents]
    colour_only = flip.hyab(*seen) ** 0.7 * 0.95 / (0.4 * flip.largest_colour_difference())
    assert errors[32, 48] > 1.1 * colour_only[32, 48]


def test_fine_noise_is_less_visible_from_afar():
    noise = 0.5 + 0.2 * (np.random.default_rng(4).random((64, 64, 3)) - 0.5)
    near, far = (flip.flip(noise, picture(0.5, (64, 64)), degrees).mean() for degrees in (20, 120))
    assert far < 0.8 * near


def test_opponent_space_is_invertible_and_matches_lab_at_white():
    colours = np.random.default_rng(5).random((100, 3))
    assert np.abs(flip.opponent_to_linear(flip.linear_to_opponent(colours)) - colours).max() < 1e-12
    assert flip.linear_to_opponent(np.ones(3)) == pytest.approx((100.0, 0.0, 0.0), abs=1e-9)
    assert flip.linear_to_lab(np.ones(3)) == pytest.approx((100.0, 0.0, 0.0), abs=1e-9)


def test_sensitivity_filters_equal_the_papers_sum_of_gaussians():
    # One bright pixel comes back as the filter itself: compare with equation 4 evaluated in two dimensions.
    degrees, size = 67.0, 41
    impulse = np.zeros((size, size, 3))
    impulse[20, 20] = 1.0
    got = flip.sensitivity_filtered(impulse, degrees)
    y, x = np.mgrid[-20:21, -20:21]
    inside = np.maximum(np.abs(x), np.abs(y)) <= 10
    squared = (x**2 + y**2) / degrees**2
    for index, terms in enumerate(([(1, 0.0047)], [(1, 0.0053)], [(34.1, 0.04), (13.5, 0.025)])):
        expected = inside * sum(a * math.sqrt(math.pi / b) * np.exp(-math.pi**2 * squared / b) for a, b in terms)
        assert np.abs(got[..., index] - expected / expected.sum()).max() < 1e-12


def test_feature_filters_answer_a_full_step_with_one_and_a_flat_area_with_nothing():
    step = np.zeros((48, 64))
    step[:, 32:] = 1.0
    edges, _ = flip.feature_strengths(step, 67.0)
    # The filter's centre tap is 0: a pixel beside the step sees all positive weights, to within that step.
    assert edges[24].max() == pytest.approx(1.0, abs=1e-9)
    assert edges[24, :20].max() < 1e-12
    flat_edges, flat_points = flip.feature_strengths(np.full((48, 64), 0.7), 67.0)
    assert flat_edges.max() < 1e-12 and flat_points.max() < 1e-12


# --- files ----------------------------------------------------------------------------------------------


def test_both_namings_of_channels():
    assert images.split_channel("R") == ("", "Combined", "R")
    assert images.split_channel("DiffDir.G") == ("", "DiffDir", "G")
    assert images.split_channel("ViewLayer.Depth.Z") == ("ViewLayer", "Depth", "Z")
    assert images.split_channel("My.Layer.Normal.X") == ("My.Layer", "Normal", "X")


def write_multilayer(path, names, values):
    """A 4x2 EXR with the channels `names`, each of one value."""
    import OpenImageIO as oiio
    spec = oiio.ImageSpec(4, 2, len(names), oiio.FLOAT)
    spec.channelnames = names
    out = oiio.ImageOutput.create(str(path))
    assert out.open(str(path), spec) and out.write_image(np.tile(np.float32(values), (2, 4, 1)))
    out.close()


def test_passes_of_a_multilayer_file(tmp_path):
    path = tmp_path / "a.exr"
    # As Blender orders them: alphabetically, which is not the order of the components.
    write_multilayer(path, ["Composite.Combined.R", "View.Combined.A", "View.Combined.B", "View.Combined.G",
                            "View.Combined.R", "View.Depth.Z", "View.Normal.X", "View.Normal.Y", "View.Normal.Z"],
                     [9, 1, 0.3, 0.2, 0.1, 5, 0, 0.6, 0.8])
    passes = images.read_passes(path)
    assert sorted(passes) == ["Combined", "Depth", "Normal"]
    assert passes["Combined"][0, 0] == pytest.approx((0.1, 0.2, 0.3, 1.0))
    assert passes["Depth"].shape == (2, 4, 1) and passes["Normal"][1, 3] == pytest.approx((0, 0.6, 0.8))
    assert images.read_pass(path).shape == (2, 4, 3)


def test_two_layers_must_be_chosen_from(tmp_path):
    path = tmp_path / "a.exr"
    write_multilayer(path, ["One.Combined.R", "Two.Combined.R"], [1, 2])
    with pytest.raises(images.ImageError, match="layers One, Two"):
        images.read_passes(path)
    assert images.read_passes(path, "Two")["Combined"][0, 0, 0] == 2


def test_what_is_written_is_read_back(tmp_path):
    colours = np.random.default_rng(6).random((5, 7, 3)).astype(np.float32) * 4
    images.write_exr(tmp_path / "a.exr", {"Combined": colours, "DiffDir": 2 * colours, "Depth": colours[..., :1]})
    passes = images.read_passes(tmp_path / "a.exr")
    assert np.array_equal(passes["Combined"], colours) and np.array_equal(passes["DiffDir"], 2 * colours)
    assert np.array_equal(passes["Depth"], colours[..., :1])
    # Eight bits: within half a step of the curve's steepest slope.
    images.write_png(tmp_path / "a.png", colours / 4)
    assert np.abs(images.read_pass(tmp_path / "a.png") - colours / 4).max() < 0.5 / 255 * 2.3


def test_the_row_at_the_top_comes_first(tmp_path):
    rows = np.zeros((3, 2, 3), np.float32)
    rows[0] = 1.0
    images.write_png(tmp_path / "a.png", rows)
    assert images.read_pass(tmp_path / "a.png")[0, 0, 0] == 1.0


def test_a_missing_file_or_pass_is_a_sentence(tmp_path):
    with pytest.raises(images.ImageError, match="There is no picture at"):
        images.read_pass(tmp_path / "none.exr")
    images.write_exr(tmp_path / "a.exr", {"Combined": picture(1.0)})
    with pytest.raises(images.ImageError, match="has no pass DiffDir; it has Combined"):
        images.read_pass(tmp_path / "a.exr", "DiffDir")
    (tmp_path / "b.exr").write_bytes(b"not a picture")
    with pytest.raises(images.ImageError, match="cannot be opened"):
        images.read_pass(tmp_path / "b.exr")


# --- the command line -----------------------------------------------------------------------------------


@pytest.fixture
def pair(tmp_path):
    """Two files, the first 10 % brighter in its lower half."""
    reference, test = picture(0.5), picture(0.5)
    test[12:] *= 1.1
    mask = picture(0.0)
    mask[:12] = 1.0
    images.write_exr(tmp_path / "a.exr", {"Combined": test, "Normal": test})
    images.write_exr(tmp_path / "b.exr", {"Combined": reference, "Normal": reference})
    images.write_png(tmp_path / "mask.png", mask)
    return [str(tmp_path / name) for name in ("a.exr", "b.exr")], tmp_path


def test_the_command_prints_every_metric(pair, capsys):
    assert compare.main(pair[0] + ["--json"]) == 0
    values = json.loads(capsys.readouterr().out)
    assert values["relative_rmse"] == pytest.approx(0.1 / math.sqrt(2), rel=1e-5)
    assert set(values) == {"relative_rmse", "rmse", "srgb_rmse", "relative_mse", "lab_rmse", "flip", "perceptual_share", "kept"}


def test_the_command_fails_where_a_bound_is_exceeded(pair, capsys):
    assert compare.main(pair[0] + ["--at-most", "relative_rmse=0.08"]) == 0
    assert compare.main(pair[0] + ["--at-most", "relative_rmse=0.07"]) == 1
    assert "above the 0.07 that is allowed" in capsys.readouterr().err
    masked = ["--mask", str(pair[1] / "mask.png"), "--at-most", "relative_rmse=0"]
    assert compare.main(pair[0] + masked) == 0
    assert "50.0%" in capsys.readouterr().out


def test_the_command_says_what_is_wrong(pair, capsys):
    assert compare.main([pair[0][0], "none.exr"]) == 2
    assert compare.main(pair[0] + ["--pass", "Depth"]) == 2
    assert compare.main(pair[0] + ["--at-most", "beauty=1"]) == 2
    assert len(capsys.readouterr().err.splitlines()) == 3


def test_the_difference_picture_tells_bright_from_dark(pair):
    out = pair[1] / "difference.png"
    assert compare.main(pair[0] + ["--difference", str(out), "--gain", "20"]) == 0
    signed = images.read_pass(out)[:, 64:]
    red, green, blue = signed[20, 5]
    assert red > green and red > blue
    assert np.ptp(signed[2, 5]) < 0.01


if __name__ == "__main__":
    raise SystemExit(pytest.main([__file__, "-q"]))
