#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Runs every suite, each with a log of its own in build/logs, and closes with one line that sums them:
#
#     N passed, N failed, N skipped
#
# `./panoptes test` calls this after it has installed, built and set Blender's folders. A suite that
# crashes, hangs or ends with an error that it did not count is one more failure; no test at all is a
# failure too. --fast leaves out what is marked slow. PANOPTES_TEST_SUITES names a selection of the
# suites native (shader validation is in it), python, blender.
set -uo pipefail

root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")
build=$root/build
logs=$build/logs
python=/usr/bin/python3
blender=${PANOPTES_BLENDER:-/usr/bin/blender}
fast=
[[ ${1:-} != --fast ]] || fast=1
export PANOPTES_TEST_FAST=$fast
cd "$root" || exit 1

passed=0 failed=0 skipped=0

wanted() { [[ " ${PANOPTES_TEST_SUITES:-native python blender} " == *" $1 "* ]]; }

# Prints "passed failed skipped" of a suite: from its JUnit file, else from the closing line in its log.
count() {
    "$python" - "$@" <<'PYTHON'
import re, sys
from xml.etree import ElementTree

log, report = sys.argv[1:]
passed = failed = skipped = 0
try:
    for suite in ElementTree.parse(report).getroot().iter("testsuite"):
        number = lambda key: int(suite.get(key) or 0)
        bad = number("failures") + number("errors")
        out = number("skipped") + number("disabled")
        passed, failed, skipped = passed + number("tests") - bad - out, failed + bad, skipped + out
except (OSError, ElementTree.ParseError):
    kinds = {"passed": 0, "xpassed": 0, "failed": 1, "error": 1, "errors": 1, "skipped": 2, "xfailed": 2}
    with open(log, errors="replace") as lines:
        for line in lines:
            words = re.findall(r"(\d+) (passed|xpassed|failed|errors?|skipped|xfailed)\b", line)
            if words and re.fullmatch(r"[=\s]*\d+ \w+(, \d+ \w+)*( in [\d.]+s.*)?[=\s]*", line):
                sums = [0, 0, 0]
                for value, kind in words:
                    sums[kinds[kind]] += int(value)
                passed, failed, skipped = sums
print(passed, failed, skipped)
PYTHON
}

# run NAME SECONDS COMMAND...: runs a suite within a time limit, and leaves its exit status, the seconds
# that it took and the limit in a file; "{report}" in the command becomes the path where it may leave a
# JUnit file.
run() {
    local name=$1 limit=$2 report=$logs/test-$1.xml began=$SECONDS
    shift 2
    rm -f "$report" "$logs/test-$name.end"
    timeout --kill-after=10 "$limit" "${@//\{report\}/$report}" >"$logs/test-$name.log" 2>&1 </dev/null
    printf '%d %d %d\n' $? $((SECONDS - began)) "$limit" >"$logs/test-$name.end"
}

# Tells how a suite ended that has run, after its name, and adds it to the sums.
tell() {
    local name=$1 log=$logs/test-$1.log status=1 seconds=0 limit=0 counts p f s
    read -r status seconds limit <"$logs/test-$name.end"
    rm -f "$logs/test-$name.end"
    counts=$(count "$log" "$logs/test-$name.xml") || counts='0 0 0'
    read -r p f s <<<"$counts"
    # pytest leaves with 5 where it found no test; the sum of all suites judges that.
    if ((status != 0 && f == 0)) && ! [[ $status == 5 && $p == 0 ]]; then f=1; fi
    printf '%5d passed %4d failed %4d skipped %6d s' "$p" "$f" "$s" "$seconds"
    case $status in
        124 | 137) printf '   (ended after its limit of %d s)' "$limit" ;;
        1[3-9]? | 12[89]) printf '   (crashed: SIG%s)' "$(kill -l $((status - 128)))" ;;
    esac
    printf '\n'
    if ((f > 0)); then
        printf -- '----- the end of %s\n' "${log#"$root"/}"
        # A line of a log must not be taken for the closing line of the whole run.
        tail -n "${PANOPTES_TEST_TAIL:-80}" "$log" | sed 's/^/    | /'
        printf -- '-----\n'
    fi
    passed=$((passed + p)) failed=$((failed + f)) skipped=$((skipped + s))
}

suite() {
    printf '%-18s ' "$1"
    run "$@"
    tell "$1"
}

pytest_options=(-ra -p no:cacheprovider -o 'markers=slow: left out by --fast' '--junitxml={report}')
slow_ctest=()
if [[ $fast ]]; then
    pytest_options+=(-m 'not slow')
    slow_ctest=(-LE slow)
fi

if wanted native; then
    # Two at a time: most of them render, and a software renderer uses every core by itself.
    suite native 1500 ctest --test-dir build -j 2 --timeout 300 --no-tests=error --output-on-failure \
        "${slow_ctest[@]}" --output-junit '{report}'
fi

# Nearly all of the time in Blender goes by on one core: in Python, in loading files, in the compiler of a
# software renderer's programs. So the suite in Blender runs beside those in the system's Python, and is
# told of after them. The native one, whose timings need the machine, has run.
in_blender=
if wanted blender && [[ -e tests/blender/run.py ]]; then
    run blender 2400 "$blender" -b --factory-startup --python-exit-code 1 -P tests/blender/run.py -- \
        "${pytest_options[@]}" &
    in_blender=$!
fi

# Every folder with Python tests of its own, in the system's Python. In-Blender tests have run.py.
if wanted python; then
    for folder in tests/*/; do
        folder=${folder%/}
        if [[ ! -e $folder/run.py ]] && compgen -G "$folder/test_*.py" >/dev/null; then
            suite "${folder##*/}" 1500 "$python" -m pytest "${pytest_options[@]}" "$folder"
        fi
    done
fi

if [[ $in_blender ]]; then
    printf '%-18s ' blender
    wait "$in_blender"
    tell blender
fi

((passed + failed > 0)) || printf 'no test ran: that counts as a failure\n'
printf '%d passed, %d failed, %d skipped\n' "$passed" "$failed" "$skipped"
((failed == 0 && passed > 0))
