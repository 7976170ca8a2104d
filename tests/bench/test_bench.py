# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmark of paths runs to its end and measures what it says; its numbers are nobody's bar here."""

import json
import os
import subprocess
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
BLENDER = os.environ.get("PANOPTES_BLENDER", "/usr/bin/blender")


@pytest.mark.slow
def test_paths_are_measured_beside_cycles():
    if not any((ROOT / "addon" / "panoptes").glob("panoptes_native*.so")):
        pytest.skip("the native module is not built; run ./panoptes build")
    done = subprocess.run(
        [BLENDER, "-b", "--factory-startup", "--python-exit-code", "1", "-P", HERE / "paths_vs_cycles.py", "--",
         "--scene", ROOT / "blend_scenes" / "atrium.blend", "--size", "32x18", "--samples", "1", "--json"],
        capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr
    found, _ = json.JSONDecoder().raw_decode(done.stdout[done.stdout.index("{"):])
    assert found["size"] == [32, 18] and set(found["engines"]) == {"CYCLES", "PANOPTES"}
    for row in found["engines"].values():
        assert row["seconds"] > 0.0 and row["cpu"] > 0.0
        # There is no finished picture of this scene.
        assert row["rmse"] is None and row["even"] is None
    assert found["runs"]["PANOPTES"][0]["trace_ms"] > 0.0
