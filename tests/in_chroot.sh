#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
#
# in_chroot.sh 4.3|5.2 [--fast]: runs the in-Blender tests in a later Blender than Debian 12's.
#
# Each later Blender comes from the Debian release that has it, in a chroot of its own (2 GB, made once
# in about 3 minutes) under PANOPTES_CHROOTS, by default build/chroots. The sources are copied in, and the
# launcher there installs, builds and tests as it would anywhere. Needs root, for chroot.
set -uo pipefail

root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")
version=$1
shift
say() { printf 'panoptes: %s\n' "$*" >&2; }

case $version in
    4.3) release=trixie ;;
    5.2) release=sid ;;
    *) say "no Debian release is known for Blender $version; choose 4.3 or 5.2."; exit 2 ;;
esac

if ((EUID != 0)); then
    if ! sudo -n true 2>/dev/null; then
        say "testing Blender $version takes root, to make a chroot of Debian $release: run it as root or with sudo."
        exit 1
    fi
    exec sudo -n "PANOPTES_CHROOTS=${PANOPTES_CHROOTS:-}" "CI=${CI:-}" bash "$0" "$version" "$@"
fi

chroots=${PANOPTES_CHROOTS:-$root/build/chroots}
chroot=$chroots/$release
log=$root/build/logs/chroot-$release.log
mkdir -p "$chroots" "$root/build/logs" || exit 1
exec 8>"$chroots/.$release.lock"
flock 8

if [[ ! -x $chroot/usr/bin/dpkg ]]; then
    if ! command -v mmdebstrap >/dev/null; then
        say "installing mmdebstrap"
        { apt-get -q update; DEBIAN_FRONTEND=noninteractive apt-get -q -y install --no-install-recommends mmdebstrap; } \
            >"$log" 2>&1 </dev/null || { say "apt-get could not install mmdebstrap; see $log."; exit 1; }
    fi
    say "making a chroot of Debian $release (log: $log)"
    rm -rf "$chroot" "$chroot.part"
    # An archive's release file outlives its date where the archive is a frozen copy.
    mmdebstrap --mode=root --variant=minbase --aptopt='Acquire::Check-Valid-Until "false"' \
        "$release" "$chroot.part" >"$log" 2>&1 </dev/null ||
        { say "mmdebstrap could not make $chroot: $(grep -m 1 '^E:' "$log"); see $log."; exit 1; }
    mv "$chroot.part" "$chroot"
fi

# The copy keeps its own build folder, so that a second run builds only what has changed.
copy=$chroot/srv/panoptes
mkdir -p "$copy"
find "$copy" -mindepth 1 -maxdepth 1 ! -name build -exec rm -rf {} +
tar -C "$root" -cf - --exclude=./build --exclude=./dist --exclude=./.git --exclude='*.so' --exclude=__pycache__ . |
    tar -C "$copy" -xf - || { say "the sources could not be copied to $copy; look for free space there."; exit 1; }

chroot "$chroot" /usr/bin/env -i HOME=/root LANG=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin CI="${CI:-}" \
    PANOPTES_TEST_SUITES=blender /srv/panoptes/panoptes test "$@" 8>&- </dev/null
