# SPDX-License-Identifier: GPL-3.0-or-later
"""A small stand-in of the repository: the real launcher over a native build that takes a second and a
Blender that only records how it was called, so that the launcher's own behaviour is tested by itself."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

CMAKE = """
cmake_minimum_required(VERSION 3.25)
project(panoptes LANGUAGES CXX)
file(APPEND ${CMAKE_SOURCE_DIR}/builds "configured\\n")
add_executable(panoptes_driver native/driver.cpp)
add_custom_target(panoptes_native ALL DEPENDS panoptes_driver
  COMMAND ${CMAKE_COMMAND} -E make_directory ${CMAKE_BINARY_DIR}/python
  COMMAND /usr/bin/python3 -c "import sysconfig; open('${CMAKE_BINARY_DIR}/python/panoptes_native' + sysconfig.get_config_var('EXT_SUFFIX'), 'w')"
  VERBATIM)
"""

# Records its arguments and environment, then does what the test has written into "act".
BLENDER = """#!/bin/bash
echo "Blender 3.4.1"
printf '%s\\n' "$@" >"$(dirname "$0")/arguments"
env >"$(dirname "$0")/environment"
pwd >"$(dirname "$0")/folder"
[[ ! -e "$(dirname "$0")/act" ]] || . "$(dirname "$0")/act"
"""


class Checkout:
    """One stand-in repository.

    root: its folder. blender: the folder with the stand-in Blender and what it recorded.
    """

    def __init__(self, root, blender):
        self.root, self.blender = root, blender
        self.environment = {**os.environ, "PANOPTES_BLENDER": str(blender / "blender")}
        for name in ("DISPLAY", "WAYLAND_DISPLAY", "PANOPTES_TEST_SUITES"):
            self.environment.pop(name, None)

    def run(self, *arguments, cwd=None, **environment):
        """Runs the launcher to its end; returns the finished process with text output."""
        return subprocess.run(
            [self.root / "panoptes", *arguments], cwd=cwd or self.root, text=True, capture_output=True,
            stdin=subprocess.DEVNULL, env={**self.environment, **environment}, timeout=300)

    def start(self, *arguments):
        """Starts the launcher and returns the running process."""
        return subprocess.Popen(
            [self.root / "panoptes", *arguments], cwd=self.root, text=True, stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=self.environment)

    def act(self, script):
        """Sets what the stand-in Blender does after it has recorded its call: a piece of bash."""
        (self.blender / "act").write_text(script)

    def recorded(self, what):
        """Lines of "arguments", "environment" or "folder" of the last call; None before the first."""
        path = self.blender / what
        return path.read_text().splitlines() if path.exists() else None

    def builds(self):
        """How often the native build was configured."""
        return (self.root / "builds").read_text().count("configured")


def make_checkout(root):
    (root / "native").mkdir(parents=True)
    (root / "shaders").mkdir()
    (root / "addon/panoptes/cli").mkdir(parents=True)
    (root / "tests").mkdir()
    shutil.copy2(ROOT / "panoptes", root)
    shutil.copy2(ROOT / "LICENSE", root)
    shutil.copy2(ROOT / "tests/run.sh", root / "tests")
    (root / "CMakeLists.txt").write_text(CMAKE)
    (root / "native/driver.cpp").write_text("int main() { return 0; }\n")
    (root / "shaders/a.glsl").write_text("void f() {}\n")
    (root / "addon/panoptes/blender_manifest.toml").write_text('version = "1.2.3"\n')
    (root / "addon/panoptes/__init__.py").write_text("")
    (root / "scene.blend").write_bytes(b"BLENDER")
    (root / "blender").mkdir()
    (root / "blender/blender").write_text(BLENDER)
    (root / "blender/blender").chmod(0o755)
    return Checkout(root, root / "blender")


@pytest.fixture(scope="session")
def built_checkout(tmp_path_factory):
    """A stand-in repository that has been built once; tests that only run commands share it."""
    checkout = make_checkout(tmp_path_factory.mktemp("launcher") / "a folder with spaces")
    done = checkout.run("render", "scene.blend", "-o", "out.png")
    assert done.returncode == 0, done.stderr
    return checkout


@pytest.fixture
def checkout(built_checkout):
    """The shared stand-in, with no recorded call and no act."""
    for name in ("act", "arguments", "environment", "folder"):
        (built_checkout.blender / name).unlink(missing_ok=True)
    return built_checkout


@pytest.fixture
def fresh_checkout(tmp_path):
    """A stand-in repository that has never been built."""
    return make_checkout(tmp_path / "checkout")


def assert_one_sentence(done, status, *words):
    """`done` failed with `status` and one line on standard error that has every one of `words`."""
    assert done.returncode == status, (done.returncode, done.stderr)
    assert done.stderr.count("\n") == 1 and done.stderr.endswith("\n"), done.stderr
    for word in words:
        assert word in done.stderr, (word, done.stderr)


