# SPDX-License-Identifier: GPL-3.0-or-later
"""When the native part is built, and what is said when it cannot be."""

import os
import shutil
import zipfile

from conftest import assert_one_sentence


def test_the_first_run_builds_and_the_second_does_not(fresh_checkout):
    first = fresh_checkout.run("render", "scene.blend")
    assert first.returncode == 0 and "building for the first time" in first.stderr
    assert list((fresh_checkout.root / "addon/panoptes").glob("panoptes_native*.so"))
    second = fresh_checkout.run("render", "scene.blend")
    assert second.returncode == 0 and second.stderr == ""
    assert fresh_checkout.builds() == 1


def test_every_kind_of_change_is_built_once(checkout):
    source, shader = checkout.root / "native/driver.cpp", checkout.root / "shaders/b.glsl"

    def changed(): source.write_text("int main() { return 3; }\n")
    def older(): os.utime(source, (1e9, 1e9))
    def added(): shader.write_text("void g() {}\n")
    def removed(): shader.unlink()
    def module_lost(): [path.unlink() for path in (checkout.root / "addon/panoptes").glob("*.so")]
    for change in (changed, older, added, removed, module_lost):
        before = checkout.builds()
        change()
        done = checkout.run("render", "scene.blend")
        assert done.returncode == 0 and "building what has changed" in done.stderr, (change, done.stderr)
        assert checkout.run("render", "scene.blend").stderr == ""
        assert checkout.builds() <= before + 1


def test_runs_at_once_build_once(fresh_checkout):
    processes = [fresh_checkout.start("render", "scene.blend") for _ in range(4)]
    words = [process.communicate(timeout=120)[1] for process in processes]
    assert [process.returncode for process in processes] == [0] * 4, words
    assert fresh_checkout.builds() == 1
    assert any("waiting for it" in text for text in words)


def test_a_failed_build_is_told_in_one_sentence_and_tried_again(fresh_checkout):
    source = fresh_checkout.root / "native/driver.cpp"
    source.write_text("int main() { return oops; }\n")
    done = fresh_checkout.run("render", "scene.blend")
    assert done.returncode == 1 and fresh_checkout.recorded("arguments") is None
    last = done.stderr.splitlines()[-1]
    assert "native/driver.cpp:1:" in last and "oops" in last and "build/logs/build.log" in last
    assert len(done.stderr.splitlines()) == 2  # "building ...", then the sentence
    source.write_text("int main() { return 0; }\n")
    assert fresh_checkout.run("render", "scene.blend").returncode == 0


def test_an_error_of_cmake_is_told_with_its_text(fresh_checkout):
    with open(fresh_checkout.root / "CMakeLists.txt", "a") as file:
        file.write('\nmessage(FATAL_ERROR "no such luck")\n')
    done = fresh_checkout.run("render", "scene.blend")
    assert done.returncode == 1 and "no such luck" in done.stderr.splitlines()[-1]


def test_a_moved_checkout_builds_anew(fresh_checkout, tmp_path):
    assert fresh_checkout.run("render", "scene.blend").returncode == 0
    shutil.move(fresh_checkout.root, tmp_path / "elsewhere")
    fresh_checkout.root = tmp_path / "elsewhere"
    fresh_checkout.blender = fresh_checkout.root / "blender"
    done = fresh_checkout.run("render", "scene.blend", PANOPTES_BLENDER=str(fresh_checkout.blender / "blender"))
    assert done.returncode == 0, done.stderr


def test_the_package_holds_one_folder_with_the_module(checkout):
    other = checkout.root / "addon/panoptes/panoptes_native.cpython-30-other.so"
    cache = checkout.root / "addon/panoptes/__pycache__"
    cache.mkdir(exist_ok=True)
    (cache / "a.pyc").touch()
    other.touch()
    try:
        done = checkout.run("package")
    finally:
        other.unlink()
    assert done.returncode == 0, done.stderr
    [path] = (checkout.root / "dist").glob("panoptes-1.2.3-*.zip")
    with zipfile.ZipFile(path) as archive:
        names = archive.namelist()
    assert {name.split("/")[0] for name in names} == {"panoptes"}
    assert {"panoptes/__init__.py", "panoptes/blender_manifest.toml", "panoptes/LICENSE"} <= set(names)
    assert sum(name.endswith(".so") for name in names) == 1
    assert not any("__pycache__" in name for name in names)
    first = path.read_bytes()
    checkout.run("package")
    assert path.read_bytes() == first


def test_a_package_without_a_version_is_refused(fresh_checkout):
    assert fresh_checkout.run("render", "scene.blend").returncode == 0
    (fresh_checkout.root / "addon/panoptes/blender_manifest.toml").write_text("")
    assert_one_sentence(fresh_checkout.run("package"), 1, "version")


def test_a_broken_test_does_not_keep_a_render_from_building(checkout):
    folder = checkout.root / "tests/native"
    folder.mkdir()
    (checkout.root / "CMakeLists.txt").open("a").write("\nif(PANOPTES_TESTS)\nadd_subdirectory(tests/native)\nendif()\n")
    try:
        assert checkout.run("render", "scene.blend").returncode == 0
        done = checkout.run("test")
        assert done.returncode == 1 and "tests/native does not contain a CMakeLists.txt" in done.stderr
        assert checkout.run("render", "scene.blend").returncode == 0
    finally:
        folder.rmdir()
        text = (checkout.root / "CMakeLists.txt").read_text()
        (checkout.root / "CMakeLists.txt").write_text(text.split("\nif(PANOPTES_TESTS)")[0])
