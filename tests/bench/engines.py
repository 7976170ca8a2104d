# SPDX-License-Identifier: GPL-3.0-or-later
"""What the benchmarks share: both engines set alike, one render measured, a process for each engine."""

import json
import subprocess
import sys
import time
from pathlib import Path

import bpy

ROOT = Path(__file__).resolve().parents[2]
ENGINES = ("CYCLES", "PANOPTES")
# Limits of paths that no measurement varies.
TRANSPARENT_BOUNCES, FILTER_GLOSSY = 16, 1.0
# The slowest scene at hand takes seconds; this only ends what hangs.
TIME_LIMIT_SECONDS = 900


def own_arguments():
    """The arguments behind Blender's own."""
    return sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []


def complete(parser, options):
    """Gives options their width, height and scene; leaves with a sentence where --size, --scene or a count is wrong."""
    try:
        options.width, options.height = (int(part) for part in options.size.lower().split("x"))
    except ValueError:
        parser.error(f"the size {options.size} is not WIDTHxHEIGHT.")
    sponza = ROOT.parent / "shared" / "scenes" / "sponza_crytek.blend"
    options.scene = options.scene or str(sponza if sponza.is_file() else ROOT / "blend_scenes" / "atrium.blend")
    if not Path(options.scene).is_file():
        parser.error(f"there is no scene at {options.scene}.")
    if min(options.width, options.height, options.repeat, options.samples) < 1:
        parser.error("sizes and counts must be at least 1.")


def register(engine):
    """Makes an engine known to Blender."""
    if engine == "PANOPTES":
        sys.path.insert(0, str(ROOT / "addon"))
        import panoptes
        panoptes.register()


def choose(scene, engine, size, samples=1):
    """Sets what both have to render: `size` pixels, nothing behind it; Cycles always takes one sample."""
    render = scene.render
    render.engine = engine
    render.resolution_x, render.resolution_y = size
    render.resolution_percentage = 100
    render.use_compositing = render.use_sequencer = render.use_persistent_data = False
    if engine == "CYCLES":
        scene.cycles.device, scene.cycles.samples = "CPU", 1
        scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
    else:
        scene.panoptes.method, scene.panoptes.samples = "realtime", samples


def choose_paths(scene, samples, bounces):
    """Sets, after choose(), that the engine traces paths: so many samples, the same limits in both, nothing clamped."""
    if scene.render.engine == "CYCLES":
        cycles = scene.cycles
        cycles.samples = samples
        cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = bounces
        cycles.transparent_max_bounces = TRANSPARENT_BOUNCES
        cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
        cycles.blur_glossy = FILTER_GLOSSY
    else:
        settings = scene.panoptes
        settings.method, settings.samples, settings.bounces = "primitive", samples, bounces
        settings.primitive.transparent_bounces = TRANSPARENT_BOUNCES
        settings.primitive.filter_glossy = FILTER_GLOSSY


def save_picture(scene, path):
    """Writes what was rendered last as a linear EXR."""
    image = scene.render.image_settings
    if hasattr(image, "media_type"):  # since Blender 5.0 the format depends on it
        image.media_type = "IMAGE"
    image.file_format, image.color_depth, image.color_mode = "OPEN_EXR", "32", "RGB"
    bpy.data.images["Render Result"].save_render(str(path), scene=scene)


def save_passes(scene, path):
    """Writes all passes of what was rendered last."""
    image = scene.render.image_settings
    if hasattr(image, "media_type"):  # since Blender 5.0 the format depends on it
        image.media_type = "MULTI_LAYER_IMAGE"
    image.file_format, image.color_depth = "OPEN_EXR_MULTILAYER", "32"
    bpy.data.images["Render Result"].save_render(str(path), scene=scene)


def measure(scene):
    """Seconds of one render, by the clock and of the processor."""
    began, used = time.perf_counter(), time.process_time()
    bpy.ops.render.render()
    seconds, cpu_seconds = time.perf_counter() - began, time.process_time() - used
    stats = json.loads(scene.panoptes.last_stats) if scene.render.engine == "PANOPTES" and scene.panoptes.last_stats else {}
    return {"seconds": seconds, "cpu_seconds": cpu_seconds, **{key: stats[key] for key in ("sync_ms", "build_ms", "trace_ms", "total_ms", "rays") if key in stats}}


def report(found):
    """Hands a child's measurements to its parent."""
    print("measured:", json.dumps(found), flush=True)


def child(script, engine, arguments):
    """Runs `script` in a process of its own with --child; returns what it reports. Leaves with a sentence where it fails."""
    command = [bpy.app.binary_path, "-b", "--factory-startup", "--python-exit-code", "1", "-P", script, "--",
               "--child", engine, *arguments]
    done = subprocess.run(command, capture_output=True, text=True, timeout=TIME_LIMIT_SECONDS)
    for line in done.stdout.splitlines():
        if line.startswith("measured:"):
            return json.loads(line.removeprefix("measured:"))
    tail = [line for line in (done.stdout + done.stderr).splitlines() if line.strip()][-8:]
    sys.exit(f"{engine} did not render (status {done.returncode}):\n" + "\n".join(tail))


def in_turns(repeat):
    """Engines in the order in which they run: taking turns spreads whatever else the machine does over both."""
    for turn in range(repeat):
        yield from ENGINES if turn % 2 == 0 else reversed(ENGINES)
