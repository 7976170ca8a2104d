# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmarks run to their ends and measure what they say; their times are nobody's bar here."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path[:0] = [str(HERE), str(ROOT / "tests" / "metrics")]

import images  # noqa: E402
import plots  # noqa: E402

BLENDER = os.environ.get("PANOPTES_BLENDER", "/usr/bin/blender")


def bench(script, *arguments):
    """What a benchmark prints as JSON."""
    if not any((ROOT / "addon" / "panoptes").glob("panoptes_native*.so")):
        pytest.skip("the native module is not built; run ./panoptes build")
    done = subprocess.run(
        [BLENDER, "-b", "--factory-startup", "--python-exit-code", "1", "-P", HERE / script, "--", "--json", *arguments],
        capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr
    return json.JSONDecoder().raw_decode(done.stdout[done.stdout.index("{"):])[0]


def bench_paths(*arguments):
    """That of paths for the atrium at a few pixels, one sample each."""
    found = bench("paths_vs_cycles.py", "--scene", ROOT / "blend_scenes" / "atrium.blend", "--size", "32x18", "--samples", "1",
                  *arguments)
    assert found["size"] == [32, 18]
    return found


def bench_occlusion(section, scene, *arguments):
    """What a section of that of ambient occlusion finds on a scene of ours, at a few pixels, with one estimator."""
    return bench("occlusion/run.py", "--section", section, "--scene", ROOT / "blend_scenes" / f"{scene}.blend", "--size", "96x54",
                 "--samples", "4", "--reference-samples", "64", "--estimator", "alchemy", *arguments)[section]


def bench_cache(scene, *arguments):
    """What that of the radiance cache finds on a scene of ours, at a few pixels."""
    return bench("cache/run.py", "--scene", ROOT / "blend_scenes" / f"{scene}.blend", "--size", "64x36", "--samples", "1", "--repeat", "1", *arguments)


def shown(path):
    """The pixels of a picture that is not of one colour, and whose file holds nothing but them."""
    assert not any(chunk in path.read_bytes() for chunk in (b"tEXt", b"zTXt", b"iTXt", b"tIME"))
    found = images.read_pass(path)
    assert found.std() > 0.01
    return found


def of_strip(path, count, size):
    """The pictures of a strip, float[count, height, width, 3], which has captions below them."""
    (width, height), found = size, shown(path)
    assert found.shape[:2] == (height + plots.CAPTION_PIXELS, count * (width + plots.GAP_PIXELS) - plots.GAP_PIXELS)
    assert found[height:].min() < 0.5 < found[height:].max()
    return np.array([found[:height, place * (width + plots.GAP_PIXELS):][:, :width] for place in range(count)])


def test_strips_hold_their_pictures_unchanged(tmp_path):
    ramp = np.linspace(0.0, 1.0, 120 * 8 * 3).reshape(8, 120, 3)
    plots.strip(tmp_path, "ramps", {"first": ramp, "second": 1.0 - ramp}, 0.5)
    first, second = images.linear_to_srgb(of_strip(tmp_path / "ramps.png", 2, (120, 8)))
    # Rows are from the bottom in the one and from the top in the other.
    assert np.abs(first[::-1] - images.linear_to_srgb(0.5 * ramp)).max() <= 0.51 / 255
    assert np.abs(second[::-1] - images.linear_to_srgb(0.5 - 0.5 * ramp)).max() <= 0.51 / 255


def test_plots_are_drawn_at_their_size(tmp_path):
    plots.lines(tmp_path, "lines", "title", "x, m", [0.0, 1.0, 3.0], {"y": {"one": [1.0, 2.0, 0.5], "other": [0.1, 0.2, 0.3]}, "z": {"one": [3.0, 1.0, 2.0]}})
    plots.stacks(tmp_path, "stacks", "title", "x", "ms", {"16": "60%", "32": "40%"}, {"first": [1.0, 2.0], "then": [3.0, 5.0]})
    width, height = plots.DIAGRAM
    assert shown(tmp_path / "lines.png").shape == (height, 2 * width, 3)
    assert shown(tmp_path / "stacks.png").shape == (height, width, 3)


def test_without_matplotlib_a_sentence_says_so_and_pictures_have_no_captions(tmp_path, monkeypatch, capsys):
    for module in ("matplotlib", "matplotlib.figure", "matplotlib.backends.backend_agg"):
        monkeypatch.setitem(sys.modules, module, None)
    ramp = np.linspace(0.0, 1.0, 20 * 8 * 3).reshape(8, 20, 3)
    plots.strip(tmp_path, "ramps", {"first": ramp, "second": ramp})
    plots.stacks(tmp_path, "stacks", "title", "x", "ms", {"16": "60%"}, {"first": [1.0]})
    assert shown(tmp_path / "ramps.png").shape == (8, 40, 3)
    assert not (tmp_path / "stacks.png").exists()
    assert capsys.readouterr().out.count("python3-matplotlib") == 1


@pytest.mark.slow
def test_paths_are_measured_beside_cycles():
    found = bench_paths()
    assert set(found["engines"]) == {"CYCLES", "PANOPTES"}
    for row in found["engines"].values():
        assert row["seconds"] > 0.0 and row["cpu"] > 0.0
        # There is no finished picture of this scene.
        assert row["rmse"] is None and row["even"] is None
    assert found["runs"]["PANOPTES"][0]["trace_ms"] > 0.0


@pytest.mark.slow
def test_structures_of_figure_7_8_give_the_same_pictures(tmp_path):
    parts = bench_paths("--figure", "7.8", "--pictures", tmp_path)["parts"]
    assert set(parts) == {"a", "b", "c"}
    for rows in parts.values():
        assert set(rows) == {"orthographic", "cube", "bvh"}
        for row in rows.values():
            assert row["rmse_of_structures"] == 0.0
            assert row["build_ms"] > 0.0 and row["sample_ms"] > 0.0 and row["rmse_of_cycles"] > 0.0
    assert parts["c"]["bvh"]["rays_a_pixel"] > parts["a"]["bvh"]["rays_a_pixel"] > 1.0
    assert (tmp_path / "figure_7_8.png").stat().st_size > 0


@pytest.mark.slow
def test_the_fast_half_of_figure_7_9_traces_fewer_rays(tmp_path):
    rows = bench_paths("--figure", "7.9", "--pictures", tmp_path)["parts"]["view"]
    assert 0.0 < rows["fast"]["rays_a_pixel"] < rows["full"]["rays_a_pixel"]
    assert rows["fast"]["relative_rmse"] > 0.0 and rows["fast"]["sample_ms_ratio"] > 0.0
    assert (tmp_path / "figure_7_9.png").stat().st_size > 0


@pytest.mark.slow
def test_maps_of_lamps_bring_occlusion_nearer_to_that_of_rays(tmp_path):
    found, = bench_occlusion("error", "colonnade", "--pictures", tmp_path)
    rows = found["rows"]
    assert found["lit"] > 0.5
    assert rows["rays"]["Cycles rmse"] < 0.05
    for name in ("alchemy lamps", "alchemy lamps + IS"):
        assert rows[name]["lit less by"] > 0.3
    assert (tmp_path / "error_colonnade_alchemy.png").stat().st_size > 0


@pytest.mark.slow
def test_phantom_views_help_where_no_lamp_shines():
    found, = bench_occlusion("error", "confined")
    rows = found["rows"]
    assert found["lit"] < 0.05
    assert abs(rows["alchemy lamps"]["less by"]) < 0.05
    assert rows["alchemy phantoms + IS"]["less by"] > 0.2


@pytest.mark.slow
def test_occlusion_by_several_views_is_steadier():
    rows = bench_occlusion("stability", "colonnade", "--every", "10")["rows"]
    assert rows["alchemy single view"]["points"] > 500
    assert rows["alchemy lamps"]["steadier"] > 1.5
    assert rows["rays"]["deviation"] < rows["alchemy lamps"]["deviation"]


@pytest.mark.slow
def test_the_cost_of_views_is_told_beside_their_samples():
    rows = bench_occlusion("cost", "colonnade", "--repeat", "1")["estimators"]["alchemy"]
    assert rows["2 views"]["samples ratio"] == pytest.approx(2.0) and rows["3 views"]["samples ratio"] == pytest.approx(3.0)
    for views in ("2 views", "3 views"):
        assert rows[f"{views} + IS"]["samples"] < rows[views]["samples"]
        assert rows[views]["time"] > 0.0
    assert rows["phantom pair + IS"]["draw ms"] > 0.0


@pytest.mark.slow
def test_cached_light_is_measured_against_both_references(tmp_path):
    found, = bench_cache("two_spots", "--section", "error", "--reference-samples", "16", "--bounces", "2", "--encoding", "y3co1cg1", "--encoding", "rgb3",
                         "--pictures", tmp_path)["error"]
    rows = found["rows"]
    assert set(rows) == {"paths, 2 bounces", "y3co1cg1, 2 bounces", "rgb3, 2 bounces"}
    assert abs(rows["paths, 2 bounces"]["energy C"] - 1.0) < 0.1
    for name in ("y3co1cg1, 2 bounces", "rgb3, 2 bounces"):
        assert rows[name]["energy"] > 0.0 and rows[name]["both"] < rows[name]["paths"]
    # Chrominance without direction shows where red and green light meet.
    assert rows["y3co1cg1, 2 bounces"]["lab"] > rows["rgb3, 2 bounces"]["lab"]
    assert all(rows[f"{name}, 2 bounces"]["clipped"] < 0.01 for name in ("y3co1cg1", "rgb3"))
    of_strip(tmp_path / "error_two_spots_2.png", 3, (64, 36))


@pytest.mark.slow
def test_what_makes_the_cache_cheaper_is_told_step_by_step(tmp_path):
    found = bench_cache("two_spots", "--section", "speed", "--part", "5.1", "--part", "5.12", "--section", "stability", "--frames", "2",
                        "--flicker-samples", "4", "--pictures", tmp_path)
    rows = found["speed"]["5.1"]["two_spots"]["rows"]
    assert rows["all cells, RGB3"]["occupancy"] == 1.0 > rows["+ occupancy"]["occupancy"] > 0.0
    assert all(row["GI ms"] > 0.0 for row in rows.values())
    # Stages are summed in their order.
    for row in found["speed"]["5.12"]["rows"].values():
        times = [value for name, value in row.items() if name != "occupancy"]
        assert times == sorted(times) and times[-1] > 0.0
    shown(tmp_path / "figure_5_12_two_spots.png")
    for row in found["stability"]["two_spots"].values():
        assert 0.0 <= row["frame mean"] <= row["frame largest"] <= row["block largest"]


@pytest.mark.slow
def test_walls_keep_light_apart(tmp_path):
    rows = bench_cache("doorway", "--section", "leaks", "--reference-samples", "32", "--pictures", tmp_path)["leaks"]["doorway"]
    # The dark room is brighter by what has leaked.
    assert rows["both sides"]["energy"] > rows["what seeds see"]["energy"]
    assert rows["both sides"]["both"] > rows["what seeds see"]["both"]
    paths, leaking, kept = of_strip(tmp_path / "leaks_doorway.png", 3, (64, 36))
    assert leaking.mean() > kept.mean()


@pytest.mark.slow
def test_ladders_climb_one_setting_at_a_time():
    found = bench_cache("canyon", "--section", "ladders", "--reference-samples", "16", "--ladder", "resolution", "--ladder", "depth stride")["ladders"]["canyon"]
    assert set(found) == {"resolution", "depth stride"}
    # Finer cells are nearer to paths, and cost more.
    coarse, fine = found["resolution"]["8"], found["resolution"]["48"]
    assert fine["both"] < coarse["both"] and fine["cache ms"] > coarse["cache ms"]


@pytest.mark.slow
def test_encodings_beside_each_other_and_the_cells_that_are_seen(tmp_path):
    found = bench_cache("two_spots", "--section", "speed", "--part", "5.6", "--part", "5.8", "--part", "5.11", "--pictures", tmp_path)["speed"]
    rows = found["5.11"]["two_spots"]
    assert set(rows) == {"y3co1cg1", "y2co2cg2", "rgb2"}
    # The third band of luminance is worth more to luminance than chrominance costs it.
    assert rows["y3co1cg1"]["luminance rmse"] < rows["y2co2cg2"]["luminance rmse"]
    # All that the first encoding of Figure 5.8 changes is how colours are written.
    errors = [row["rmse"] for row in found["5.8"]["two_spots"].values()]
    assert errors == sorted(errors) and errors[0] < 0.001 < errors[-1]
    for figure in ("5_8", "5_11"):
        assert of_strip(tmp_path / f"figure_{figure}_two_spots.png", 4, (64, 36)).std(axis=(1, 2, 3)).min() > 0.01
    seen = [row["depth occupancy"] for row in found["5.6"]["rows"].values()]
    assert all(row["depth occupancy"] < row["geometry occupancy"] <= 1.0 for row in found["5.6"]["rows"].values())
    assert seen[-1] < seen[0]
    shown(tmp_path / "figure_5_6_two_spots.png")


@pytest.mark.slow
def test_the_inside_of_the_cache_is_shown(tmp_path):
    found = bench_cache("two_spots", "--section", "inside", "--pictures", tmp_path)["inside"]["rows"]
    assert set(found) == {"geometry", "occupancy", "lobes", "light", "clipped"}
    assert found["clipped"]["mean"] < 0.01
    assert of_strip(tmp_path / "inside_two_spots.png", 5, (64, 36))[:4].std(axis=(1, 2, 3)).min() > 0.01


@pytest.mark.slow
def test_a_whole_picture_is_measured_beside_cycles_first_sample():
    found = bench_cache("two_spots", "--section", "frame", "--reference-samples", "16", "--frame-samples", "1")["frame"]["two_spots"]
    assert set(found["rows"]) == {"CYCLES", "CYCLES anew", "PANOPTES 1"}
    for row in found["rows"].values():
        assert row["s"] > 0.0 and row["cpu s"] > 0.0 and 0.0 < row["srgb rmse"] < 0.5
    assert found["rows"]["PANOPTES 1"]["passes"]


@pytest.mark.slow
@pytest.mark.skipif(not (shutil.which("xvfb-run") and shutil.which("xauth")), reason="needs xvfb-run and xauth")
def test_edits_in_a_3d_view_are_timed_beside_cycles(tmp_path):
    [found] = bench("viewport/run.py", "--scene", ROOT / "blend_scenes" / "two_spots.blend", "--window", "480x360", "--samples", "4", "--repeat", "1",
                    "--edits", "2", "--pictures", tmp_path)["viewport"]
    assert set(found["rows"]) == {"CYCLES", "PANOPTES"}
    for engine, row in found["rows"].items():
        assert 0.0 < row["first s"] <= row["full s"] and 0.0 < row["rmse"] < 0.5
        assert shown(tmp_path / f"viewport_two_spots_{engine.lower()}.png").shape[:2] == tuple(found["size"][::-1])


def test_what_the_denoiser_makes_of_few_samples():
    found = bench("denoise.py", "--scene", ROOT / "blend_scenes" / "doorway.blend", "--size", "48x27", "--samples", "2,4",
                  "--reference", "32")
    for row in found["denoise"]:
        assert row["denoised_srgb"] < row["noisy_srgb"] and row["worth"] > row["samples"]
        assert row["denoiser_ms"] > 0.0 and 0.0 < row["estimate"] < 10.0


def test_what_fragments_lose_beside_primitives(tmp_path):
    found = bench("fragments.py", "--scene", ROOT / "blend_scenes" / "doorway.blend", "--size", "48x27", "--samples", "2",
                  "--reference", "8", "--variant", "all", "--variant", "one view, one layer", "--pictures", tmp_path)["fragments"]
    assert found["primitives"]["energy"] == 1.0 and found["primitives"]["apart"] == 0.0
    assert 0.0 < found["all"]["apart"] < found["one view, one layer"]["apart"]
    for row in found.values():
        assert row["trace ms"] > 0.0 and row["error"] > 0.0
    exact, fewest, whole = of_strip(tmp_path / "views_doorway.png", 3, (48, 27))
    assert abs(whole - exact).mean() < abs(fewest - exact).mean()
    of_strip(tmp_path / "occlusion_doorway.png", 3, (48, 27))
