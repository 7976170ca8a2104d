# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmark of the ray tracers: its reports on a few rays, and third-party scenes against Embree.

The program is built by `./panoptes test`. Scenes that lie beside the repository are skipped where they
are not.
"""

import json
import math
import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BENCH = ROOT / "build" / "panoptes_ray_bench"
SCENES = ROOT.parent / "shared" / "scenes"

pytestmark = pytest.mark.skipif(not BENCH.exists(), reason="./panoptes test builds the benchmark")


def run(*arguments):
    return subprocess.run([BENCH, *arguments], text=True, capture_output=True, stdin=subprocess.DEVNULL,
                          timeout=300)


def tables(*arguments):
    """The tables of a run: a list of {"title", "rows"}, rows being dictionaries by column."""
    done = run("--json", *arguments)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)["tables"]


def assert_only_rounding_differs(found):
    """Every difference from Embree in tables of rays is excused by rounding."""
    traced = [(table["title"], row) for table in found for row in table["rows"] if "structural" in row]
    ours = [(title, row) for title, row in traced if row["structural"] is not None]
    assert ours
    for title, row in ours:
        for kind in ("structural", "wrong", "neither"):
            assert row[kind] == 0, (title, row)


def test_the_speed_report_compares_with_embree():
    found = tables("--scene", "box_room", "--rays", "2000")
    builds, *sets = found
    assert [row["build"] for row in builds["rows"]][:3] == ["Embree medium", "Embree low", "Embree robust"]
    assert len(builds["rows"]) > 3 and len(sets) == 10
    assert all(row["wall ms"] > 0 for row in builds["rows"])
    for table in sets:
        assert table["rows"][0]["of Embree"] == 1
        assert all(row["Mrays/s"] > 0 for row in table["rows"])
    assert_only_rounding_differs(found)


@pytest.mark.parametrize("arguments", [
    ("--table", "6.1"), ("--table", "6.2"), ("--table", "7.1"), ("--table", "7.2"), ("--table", "7.3"), ("--figure", "6.11"),
    ("--figure", "6.12"), ("--figure", "7.8"), ("--figure", "7.10"), ("--figure", "7.11")])
def test_the_thesis_tables_are_filled(arguments):
    (table,) = tables(*arguments, "--scene", "box_room", "--rays", "1024")
    assert table["rows"]
    for row in table["rows"]:
        assert all(cell is not None and (isinstance(cell, str) or math.isfinite(cell)) for cell in row.values())


def test_a_deforming_scene_is_built_anew_each_frame():
    (table,) = tables("--deform", "--scene", "box_room", "--scene", "box_room", "--rays", "1024")
    assert "mean of 2 frames" in table["title"]
    assert {"Embree low", "Embree medium"} < {row["tracer"] for row in table["rows"]}
    for row in table["rows"]:
        assert row["frame"] == pytest.approx(row["build"] + row["primary"] + row["shadow"] + row["diffuse"])


def test_one_tracer_and_one_set_can_be_chosen():
    _, table = tables("--scene", "box_room", "--rays", "1000", "--tracer", "orthographic", "--set", "diffuse")
    assert table["title"].startswith("box_room, diffuse: 1000 rays")
    assert [row["tracer"] for row in table["rows"]][3:] == ["orthographic"]


@pytest.mark.parametrize("arguments, words", [
    (("--rays", "many"), ("--rays", "many")),
    (("--rays", "0"), ("--rays", "0")),
    (("--tracer", "sphere"), ("sphere", "orthographic")),
    (("--scene", "moon"), ("moon", "atrium")),
    (("--scene", "gone.scene"), ("gone.scene",)),
    (("--table", "9.9"), ("9.9",)),
    (("--fast",), ("--fast", "--help")),
    (("--set",), ("--set",)),
])
def test_mistakes_are_told_in_one_sentence(arguments, words):
    done = run(*arguments)
    assert done.returncode == 1 and done.stdout == ""
    assert done.stderr.count("\n") == 1, done.stderr
    assert all(word in done.stderr for word in words), done.stderr


@pytest.mark.parametrize("name", [
    "cornell", "fox_skinned", "foliage_ivy_oak",
    pytest.param("sponza_crytek", marks=pytest.mark.slow)])
def test_third_party_scenes_differ_from_embree_only_by_rounding(name, tmp_path):
    blend = SCENES / f"{name}.blend"
    if not blend.exists():
        pytest.skip(f"{name}.blend does not lie beside the repository")
    snapshot = tmp_path / f"{name}.scene"
    done = subprocess.run([ROOT / "panoptes", "snapshot", blend, "-o", snapshot], text=True, capture_output=True,
                          stdin=subprocess.DEVNULL, env=os.environ, timeout=300)
    assert done.returncode == 0, done.stderr
    assert_only_rounding_differs(tables("--scene", str(snapshot), "--rays", "20000", "--judge", "60"))
