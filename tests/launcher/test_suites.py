# SPDX-License-Identifier: GPL-3.0-or-later
"""The runner of the suites: its closing line, which continuous integration reads, and its exit status."""

import subprocess

import pytest

CLOSING = "{} passed, {} failed, {} skipped"


def run_suites(checkout, act="", tests=None, suites="python blender"):
    """Runs tests/run.sh over one Python suite with the text `tests` and an in-Blender suite that `act`s.

    Returns the exit status and the output's lines.
    """
    checkout.act(act)
    for name in ("sample", "blender"):
        (checkout.root / "tests" / name).mkdir(exist_ok=True)
    (checkout.root / "tests/blender/run.py").touch()
    sample = checkout.root / "tests/sample/test_sample.py"
    sample.unlink(missing_ok=True)
    if tests is not None:
        sample.write_text(tests)
    done = subprocess.run(["bash", checkout.root / "tests/run.sh"], text=True, capture_output=True,
                          env={**checkout.environment, "PANOPTES_TEST_SUITES": suites})
    return done.returncode, done.stdout.splitlines()


def test_the_closing_line_sums_all_suites(checkout):
    status, lines = run_suites(
        checkout, act="echo '==== 5 passed, 2 skipped, 1 xfailed in 0.10s ===='",
        tests="import pytest\ndef test_a(): pass\ndef test_b(): pytest.skip()\n")
    assert status == 0 and lines[-1] == CLOSING.format(6, 0, 4)


def test_the_plain_closing_line_of_an_in_blender_run_counts_too(checkout):
    status, lines = run_suites(checkout, act="echo '7 passed, 0 failed, 1 skipped'; echo 'Blender quit'")
    assert status == 0 and lines[-1] == CLOSING.format(7, 0, 1)


def test_the_suite_in_blender_runs_beside_the_others_and_is_told_last(checkout):
    """Each suite waits, 30 seconds at most, until the other has begun."""
    python, blender = checkout.root / "python-runs", checkout.root / "blender-runs"
    wait = "touch '{}'; timeout 30 bash -c 'until [[ -e $0 ]]; do sleep .1; done' '{}'"
    status, lines = run_suites(
        checkout, act=wait.format(blender, python) + " && echo '3 passed'",
        tests=f"import subprocess\ndef test_a(): subprocess.run(['bash', '-c', {wait.format(python, blender)!r}], check=True)\n")
    assert status == 0 and lines[-1] == CLOSING.format(4, 0, 0)
    assert [line.split()[:2] for line in lines[:-1]] == [["sample", "1"], ["blender", "3"]]


def test_a_failure_is_counted_and_its_log_shown(checkout):
    status, lines = run_suites(checkout, tests="def test_a(): assert 'apple' == 'pear'\ndef test_b(): pass\n",
                               act="echo '1 passed, 0 failed'")
    assert status == 1 and lines[-1] == CLOSING.format(2, 1, 0)
    assert any("apple" in line for line in lines)


@pytest.mark.parametrize("act", ["exit 1", "kill -SEGV $$", "echo '3 passed, 0 failed'; exit 1"])
def test_a_suite_that_dies_is_a_failure(checkout, act):
    status, lines = run_suites(checkout, act=act, tests="def test_a(): pass\n")
    assert status == 1 and " 1 failed, " in lines[-1]


def test_an_import_error_is_a_failure(checkout):
    status, lines = run_suites(checkout, act="echo '1 passed, 0 failed'", tests="import no_such_module\n")
    assert status == 1 and lines[-1] == CLOSING.format(1, 1, 0)


def test_no_test_at_all_is_a_failure(checkout):
    status, lines = run_suites(checkout, tests="x = 1\n", suites="python")
    assert status == 1 and lines[-1] == CLOSING.format(0, 0, 0)


def test_only_the_last_line_reads_like_a_closing_line(checkout):
    import re
    _, lines = run_suites(checkout, tests="def test_a(): assert 0\n", act="echo '4 passed, 1 failed'; exit 1")
    assert [line for line in lines if re.fullmatch(r"(\w+: )?\d+ passed, \d+ failed(, \d+ skipped)?", line)] == lines[-1:]
