# SPDX-License-Identifier: GPL-3.0-or-later
"""The whole line: the repository's own launcher, build and Blender, over a scene of our own."""

import json
import os
import subprocess
import time

import pytest
from conftest import ROOT, assert_one_sentence

SCENES = sorted((ROOT / "blend_scenes").glob("*.blend"))
PNG = b"\x89PNG\r\n\x1a\n"


def panoptes(*arguments, cwd=ROOT, **environment):
    """Runs the repository's launcher to its end; returns the finished process with text output."""
    return subprocess.run([ROOT / "panoptes", *arguments], cwd=cwd, text=True, capture_output=True,
                          stdin=subprocess.DEVNULL, env={**os.environ, **environment}, timeout=900)


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    """A copy of a scene in a folder with a space in its name; the folder is the home as well."""
    assert SCENES, "blend_scenes/ holds no .blend"
    folder = tmp_path_factory.mktemp("real") / "my pictures"
    folder.mkdir()
    (folder / "my scene.blend").write_bytes(SCENES[0].read_bytes())
    return folder / "my scene.blend"


@pytest.fixture(scope="module")
def render(scene):
    """A small render of the scene, by names relative to its folder: (finished process, folder)."""
    done = panoptes("render", scene.name, "-o", "a picture.png", "--size", "64x36", "--samples", "1",
                    "--stats", "its stats.json", cwd=scene.parent, HOME=str(scene.parent))
    return done, scene.parent


def test_a_picture_is_written_where_the_caller_stands(render):
    done, folder = render
    assert done.returncode == 0, done.stderr
    assert done.stdout == ""
    picture = (folder / "a picture.png").read_bytes()
    assert picture.startswith(PNG)
    assert (int.from_bytes(picture[16:20], "big"), int.from_bytes(picture[20:24], "big")) == (64, 36)


def test_the_statistics_are_written_beside_it(render):
    done, folder = render
    assert done.returncode == 0, done.stderr
    stats = json.loads((folder / "its stats.json").read_text())
    assert list(stats["size"]) == [64, 36]
    assert stats["effects"]


def test_the_home_folder_keeps_no_trace_of_blender(render):
    done, folder = render
    assert done.returncode == 0, done.stderr
    traces = [path for path in folder.rglob("*") if path.suffix != ".blend" and "blender" in path.name.lower()]
    assert traces == []


def test_an_output_of_an_unknown_kind_is_refused(scene):
    done = panoptes("render", scene.name, "-o", "picture.bmpx", cwd=scene.parent)
    assert_one_sentence(done, done.returncode, "picture.bmpx")
    assert done.returncode in (1, 2)
    assert not (scene.parent / "picture.bmpx").exists()


def test_a_file_that_is_no_blend_is_told_in_one_sentence(tmp_path):
    (tmp_path / "text.blend").write_text("not a scene")
    done = panoptes("render", "text.blend", "-o", "out.png", cwd=tmp_path)
    assert done.returncode != 0 and "text.blend" in done.stderr
    assert done.stderr.count("\n") == 1, done.stderr
    assert list(tmp_path.glob("out*")) == []


def test_what_the_launcher_adds_before_blender_starts(render, tmp_path):
    """The limit of a second is generous: a loaded machine must not fail the test."""
    blender = tmp_path / "blender"
    blender.write_text("#!/bin/sh\n")
    blender.chmod(0o755)
    (tmp_path / "a.blend").touch()
    panoptes("render", "a.blend", cwd=tmp_path, PANOPTES_BLENDER=str(blender))
    times = []
    for _ in range(3):
        began = time.perf_counter()
        assert panoptes("render", "a.blend", cwd=tmp_path, PANOPTES_BLENDER=str(blender)).returncode == 0
        times.append(time.perf_counter() - began)
    print(f"the launcher takes {min(times) * 1000:.0f} ms before Blender starts")
    assert min(times) < 1
