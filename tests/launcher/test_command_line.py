# SPDX-License-Identifier: GPL-3.0-or-later
"""What the launcher says, and with which exit status, before anything is built or started."""

import shutil
import subprocess

import pytest
from conftest import ROOT, assert_one_sentence


@pytest.mark.parametrize("arguments", [(), ("--help",), ("help",), ("render", "--help"), ("test", "--help")])
def test_help_lists_the_commands_of_this_version(checkout, arguments):
    done = checkout.run(*arguments)
    assert done.returncode == 0 and done.stderr == ""
    for command in ("render", "merge", "viewport", "snapshot", "test", "bench", "package"):
        assert f"./panoptes {command}" in done.stdout
    assert "report" not in done.stdout


def test_a_command_of_a_later_version_is_refused(checkout):
    assert_one_sentence(checkout.run("report"), 2, "report", "not part of this version")


@pytest.mark.parametrize("arguments, words", [
    ((), ("needs a picture to write",)),
    (("out.exr",), ("needs a picture to write",)),
    (("out.exr", "gone.exr"), ("there is no file gone.exr",)),
])
def test_mistakes_with_merge_are_told_before_blender_starts(checkout, arguments, words):
    assert_one_sentence(checkout.run("merge", *arguments), 2, *words)
    assert checkout.recorded("arguments") is None


def test_merge_hands_its_files_to_blender(checkout):
    assert checkout.run("merge", "out.exr", "scene.blend", "scene.blend").returncode == 0
    assert checkout.recorded("arguments")[-4:] == ["merge", "out.exr", "scene.blend", "scene.blend"]


def test_an_unknown_command_is_refused(checkout):
    assert_one_sentence(checkout.run("rendr", "scene.blend"), 2, "rendr", "--help")


def test_a_file_without_a_command_gets_the_command_that_was_meant(checkout):
    assert_one_sentence(checkout.run("scene.blend"), 2, "./panoptes render scene.blend")


@pytest.mark.parametrize("command", ["render", "snapshot", "viewport"])
@pytest.mark.parametrize("arguments, words", [
    ((), ("needs a .blend file",)),
    (("-o", "scene.blend"), ("needs a .blend file",)),
    (("no such.blend", "-o", "out.png"), ("there is no file no such.blend",)),
    (("--set", "a=1", "--set", "b=2", "gone.blend"), ("there is no file gone.blend",)),
    (("native",), ("native is not a file",)),
])
def test_a_missing_file_is_told_before_blender_starts(checkout, command, arguments, words):
    assert_one_sentence(checkout.run(command, *arguments, DISPLAY=":0"), 2, *words)
    assert checkout.recorded("arguments") is None


def test_a_missing_file_is_told_before_anything_is_built(fresh_checkout):
    assert_one_sentence(fresh_checkout.run("render", "gone.blend"), 2, "gone.blend")
    assert not (fresh_checkout.root / "build").exists()


@pytest.mark.parametrize("arguments, words", [
    (("--scene", "gone.blend"), ("there is no file gone.blend",)),
    (("--rays", "5", "--scene"), ("--scene needs a value",)),
    (("--deform", "--scene", "a.blend", "--frames", "7"), ("--frames", "FIRST:LAST")),
])
def test_mistakes_with_the_ray_benchmark_are_told_before_anything_is_built(fresh_checkout, arguments, words):
    (fresh_checkout.root / "a.blend").touch()
    assert_one_sentence(fresh_checkout.run("bench", "rays", *arguments, cwd=fresh_checkout.root), 2, *words)
    assert not (fresh_checkout.root / "build").exists()


def test_the_viewport_needs_a_screen(checkout):
    assert_one_sentence(checkout.run("viewport", "scene.blend"), 1, "screen")


@pytest.mark.parametrize("arguments", [("--slow",), ("--blender",), ("--blender", "2.8")])
def test_unknown_options_of_test_are_refused(checkout, arguments):
    assert_one_sentence(checkout.run("test", *arguments), 2)


@pytest.mark.skipif(not shutil.which("shellcheck"), reason="shellcheck is not installed")
def test_the_scripts_pass_shellcheck():
    scripts = [ROOT / "panoptes", ROOT / ".ci/run", ROOT / "tests/run.sh", ROOT / "tests/in_chroot.sh"]
    done = subprocess.run(["shellcheck", *scripts], text=True, capture_output=True)
    assert done.returncode == 0, done.stdout
