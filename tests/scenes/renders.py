# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders scenes in Blender for the comparisons, and keeps Cycles' pictures for the next time.

Runs in the system's Python, with one Blender beside it that renders lists of pictures (in_blender.py).
Cycles' pictures are kept in build/reference-cache under a key of everything that they depend on: the
scene's bytes, the scripts, the settings and Blender's version. Panoptes' pictures are never kept.
"""

import atexit
import collections
import functools
import hashlib
import json
import os
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(HERE.parent / "metrics"))

import images  # noqa: E402

CACHE = ROOT / "build" / "reference-cache"
SHARED = Path(os.environ.get("PANOPTES_SHARED_SCENES", ROOT.parent / "shared" / "scenes"))
BLENDER = os.environ.get("PANOPTES_BLENDER", "/usr/bin/blender")
# Scenes that scripts build, by the prefix of their names.
BUILT = {"builder:": ("builders.py",), "nodes:": ("node_atlas.py", "node_cases.py", "node_values.py", "node_textures.py", "node_shaders.py")}
# One render of one picture takes seconds; this only ends what hangs.
TIME_LIMIT_SECONDS = 1200


class RenderFailed(RuntimeError):
    """Blender did not deliver a picture; the message names the scene and the cause."""


def scene_path(name):
    """The .blend of one of our own scenes, else of a shared one; "builder:NAME" and "nodes:GROUP" as they are."""
    own = ROOT / "blend_scenes" / f"{name}.blend"
    return name if name.startswith(tuple(BUILT)) else str(own if own.is_file() else SHARED / f"{name}.blend")


def panoptes_is_built():
    """Whether the native module lies beside the add-on."""
    return any((ROOT / "addon" / "panoptes").glob("panoptes_native*.so"))


@functools.cache
def blender_version():
    """The first line of blender --version."""
    return subprocess.run([BLENDER, "--version"], capture_output=True, text=True, check=True).stdout.splitlines()[0]


@functools.cache
def _digest(path):
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()


def _key(scene, request):
    """A name for what Cycles would render."""
    sources = [_digest(HERE / "in_blender.py")]
    scripts = next((found for prefix, found in BUILT.items() if scene.startswith(prefix)), None)
    sources += [_digest(HERE / script) for script in scripts] if scripts else [_digest(scene)]
    text = json.dumps([sources, scene.rpartition("/")[2], blender_version(), request], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:24]


def picture(engine, samples=None, shadows=True, seed=1, lamp=None, method=None, bounces=None):
    """One entry of a list for `render`.

    seed: of Cycles, and of Panoptes with a method. lamp: the index of the only lamp that shines, None for all.
    method: of Panoptes, with every pass that it fills; None keeps the file's own settings. bounces: of indirect light, of
    all kinds; None keeps the file's own.
    """
    return {"engine": engine, "samples": samples, "shadows": shadows, "seed": seed, "lamp": lamp, "method": method, "bounces": bounces}


def render(name, pictures, lamps_alone=False, size=None):
    """Renders the scene once for each of `pictures`.

    name: a scene of blend_scenes, a shared one, "builder:NAME" or "nodes:GROUP". size: (width, height), None for the file's own.
    Returns (list of {pass: float32[H, W, C]} in the order of `pictures`, number of lamps).
    Raises RenderFailed.
    """
    scene = scene_path(name)
    common = {"lamps_alone": lamps_alone, "size": size and list(size)}
    CACHE.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        outs, wanted, kept = [], [], {}
        for index, entry in enumerate(pictures):
            out = (CACHE / f"{name.replace(':', '-')}-{_key(scene, {**entry, **common})}.exr"
                   if entry["engine"] == "CYCLES" else Path(folder) / f"{index}.exr")
            outs.append(out)
            if not out.exists():
                # Written elsewhere first: an interrupted render leaves nothing that looks finished.
                made = Path(folder) / f"made-{index}.exr"
                kept[made] = out
                wanted.append({**entry, "out": str(made)})
        count_file = CACHE / f"lamps-{_key(scene, 'lamps')}"
        if wanted or not count_file.exists():
            count_file.write_text(_run(name, {"scene": scene, "renders": wanted, **common}, folder))
        for made, out in kept.items():
            if not made.exists():
                raise RenderFailed(f"{name}: Blender wrote no picture; run it again by hand and read its log.")
            made.replace(out) if made.stat().st_dev == out.parent.stat().st_dev else out.write_bytes(made.read_bytes())
        return [images.read_passes(out) for out in outs], int(count_file.read_text())


_blender = None


def _running_blender():
    """The Blender that does the jobs; a new one where there is none or the last has ended."""
    global _blender
    if _blender is None or _blender.poll() is not None:
        _blender = subprocess.Popen(
            [BLENDER, "-b", "--factory-startup", "--python-exit-code", "1", "-P", HERE / "in_blender.py"],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return _blender


@atexit.register
def _end():
    """Ends the Blender that has done the jobs."""
    if _blender is not None and _blender.poll() is None:
        _blender.stdin.close()
        _blender.stdout.read()
        _blender.wait()


def _run(name, job, folder):
    """Runs the job in Blender; returns the number of lamps that it printed."""
    path = Path(folder) / "job.json"
    path.write_text(json.dumps(job))
    blender, late, tail = _running_blender(), threading.Event(), collections.deque(maxlen=12)

    def stop():
        late.set()
        blender.kill()

    timer = threading.Timer(TIME_LIMIT_SECONDS, stop)
    timer.start()
    try:
        print(path, file=blender.stdin, flush=True)
        for line in blender.stdout:
            if line.startswith("lamps:"):
                return line.split()[1]
            if line.strip():
                tail.append(line.rstrip())
    except BrokenPipeError:
        tail.append("It ended before the job.")
    finally:
        timer.cancel()
    if late.is_set():
        raise RenderFailed(f"{name}: Blender was not done after {TIME_LIMIT_SECONDS} s; render it by hand.")
    raise RenderFailed(f"{name}: Blender left with status {blender.wait()}:\n" + "\n".join(tail))
