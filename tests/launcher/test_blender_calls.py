# SPDX-License-Identifier: GPL-3.0-or-later
"""How Blender is started, what becomes of its words, its exit status and its signals."""

import signal
import time

import pytest
from conftest import assert_one_sentence


def variables(checkout):
    return dict(line.split("=", 1) for line in checkout.recorded("environment") if "=" in line)


def test_arguments_and_folder_arrive_unchanged(checkout, tmp_path):
    (tmp_path / "my scene.blend").write_bytes(b"BLENDER")
    given = ["my scene.blend", "-o", "out dir/a b.png", "--set", "k=v w", "x=*", "--stats", ""]
    done = checkout.run("render", *given, cwd=tmp_path)
    assert done.returncode == 0 and done.stderr == "" and done.stdout == ""
    options, arguments = split(checkout)
    assert arguments == ["render", *given]
    assert "-b" in options and "--factory-startup" in options
    assert options[options.index("-P") + 1] == str(checkout.root / "addon/panoptes/cli/main.py")
    assert checkout.recorded("folder") == [str(tmp_path)]


def split(checkout):
    """Options before "--" and arguments after it of the recorded call."""
    lines = checkout.recorded("arguments")
    return lines[:lines.index("--")], lines[lines.index("--") + 1:]


def test_the_viewport_opens_a_window(checkout):
    assert checkout.run("viewport", "scene.blend", DISPLAY=":99").returncode == 0
    options, arguments = split(checkout)
    assert "-b" not in options and "--factory-startup" in options
    assert arguments == ["viewport", "scene.blend"]


def test_a_link_to_the_launcher_works(checkout, tmp_path):
    (tmp_path / "pan").symlink_to(checkout.root / "panoptes")
    (tmp_path / "s.blend").write_bytes(b"BLENDER")
    import subprocess
    done = subprocess.run([tmp_path / "pan", "render", "s.blend"], cwd=tmp_path, env=checkout.environment)
    assert done.returncode == 0 and checkout.recorded("folder") == [str(tmp_path)]


def test_the_users_own_configuration_is_out_of_reach(checkout, tmp_path):
    theirs = str(tmp_path / "theirs")
    names = ["BLENDER_USER_" + name for name in ("RESOURCES", "CONFIG", "SCRIPTS", "DATAFILES", "EXTENSIONS")]
    checkout.run("render", "scene.blend", HOME=theirs, PYTHONPATH=theirs, PYTHONHOME=theirs,
                 BLENDER_SYSTEM_SCRIPTS=theirs, **{name: theirs for name in names})
    seen = variables(checkout)
    for name in names:
        assert seen[name].startswith(str(checkout.root / "build/blender-user")), name
    assert seen["PYTHONNOUSERSITE"] == "1"
    assert [name for name, value in seen.items() if value == theirs] == ["HOME"]
    assert not (tmp_path / "theirs").exists()


def test_blenders_chatter_goes_to_a_log_and_the_commands_words_to_the_caller(checkout):
    checkout.act('echo chatter; echo more >&2; echo "a word" >&"$PANOPTES_STDERR_FD"')
    done = checkout.run("render", "scene.blend")
    assert done.stdout == "" and done.stderr == "a word\n" and done.returncode == 0
    logs = sorted((checkout.root / "build/logs").glob("render-*.log"), key=lambda path: path.stat().st_mtime)
    assert "chatter\nmore\n" in logs[-1].read_text()


@pytest.mark.parametrize("status", [1, 2, 3, 77])
def test_a_failure_that_the_command_explained_passes_through(checkout, status):
    checkout.act(f'echo "cause and remedy." >&9; exit {status}')
    done = checkout.run("render", "scene.blend")
    assert done.returncode == status and done.stderr == "cause and remedy.\n"


def test_an_uncaught_exception_is_told_in_one_sentence(checkout):
    checkout.act('echo "Traceback (most recent call last):"; echo "KeyError: 5"; exit 70')
    assert_one_sentence(checkout.run("render", "scene.blend"), 1, "KeyError: 5", "build/logs/render-")


@pytest.mark.parametrize("name, number", [("SEGV", 11), ("ABRT", 6), ("FPE", 8)])
def test_a_crash_is_told_in_one_sentence(checkout, name, number):
    checkout.act(f"kill -{name} $$")
    assert_one_sentence(checkout.run("snapshot", "scene.blend"), 128 + number, "SIG" + name, "build/logs/snapshot-")


def test_a_killed_blender_is_told_with_the_likely_cause(checkout):
    checkout.act("kill -KILL $$")
    assert_one_sentence(checkout.run("render", "scene.blend"), 137, "memory")


def test_a_blender_that_does_not_exist_is_told(checkout):
    done = checkout.run("render", "scene.blend", PANOPTES_BLENDER="/nowhere/blender")
    assert_one_sentence(done, 127, "/nowhere/blender", "PANOPTES_BLENDER")


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT, signal.SIGHUP])
def test_ending_the_launcher_ends_blender(checkout, number):
    checkout.act("trap 'echo ended >&9; kill $!; exit 5' TERM INT; sleep 60 & wait")
    process = checkout.start("render", "scene.blend")
    while checkout.recorded("environment") is None:
        time.sleep(.05)
    time.sleep(.2)
    process.send_signal(number)
    _, words = process.communicate(timeout=10)
    assert words == "ended\n" and process.returncode == 5


def test_a_reader_that_goes_away_does_not_end_blender(checkout):
    checkout.act("sleep .3; for i in 1 2 3; do echo word >&9; done 2>/dev/null; touch \"$(dirname \"$0\")/folder.done\"")
    process = checkout.start("render", "scene.blend")
    process.stderr.close()
    process.wait(timeout=10)
    (checkout.blender / "folder.done").unlink()


def test_a_second_run_adds_less_than_a_second(checkout):
    checkout.run("render", "scene.blend")
    times = []
    for _ in range(5):
        began = time.perf_counter()
        checkout.run("render", "scene.blend")
        times.append(time.perf_counter() - began)
    print(f"launcher and stand-in Blender: {min(times) * 1000:.0f} ms")
    assert min(times) < 1
