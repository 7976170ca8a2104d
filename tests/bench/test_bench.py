# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmark of paths runs to its end and measures what it says; its times are nobody's bar here."""

import json
import os
import subprocess
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
BLENDER = os.environ.get("PANOPTES_BLENDER", "/usr/bin/blender")


def bench_paths(*arguments):
    """What the benchmark of paths prints as JSON for the atrium at a few pixels, one sample each."""
    if not any((ROOT / "addon" / "panoptes").glob("panoptes_native*.so")):
        pytest.skip("the native module is not built; run ./panoptes build")
    done = subprocess.run(
        [BLENDER, "-b", "--factory-startup", "--python-exit-code", "1", "-P", HERE / "paths_vs_cycles.py", "--",
         "--scene", ROOT / "blend_scenes" / "atrium.blend", "--size", "32x18", "--samples", "1", "--json", *arguments],
        capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr
    found, _ = json.JSONDecoder().raw_decode(done.stdout[done.stdout.index("{"):])
    assert found["size"] == [32, 18]
    return found


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
