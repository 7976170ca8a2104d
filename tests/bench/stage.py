# SPDX-License-Identifier: GPL-3.0-or-later
"""One scene under the camera of a bench: passes of our methods and of Cycles as arrays.

Ours are asked for from the native engine itself, so that a picture costs no file and one synchronisation serves many.
All look through the pixels' centres (the narrowest filter that there is), so that every method sees the same first
surfaces and pictures differ by their light alone. Rows are from the bottom up, as the engine gives them.
"""

import contextlib
import os
import statistics
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

import bpy
import images
import numpy as np
from engines import ROOT, register

# The narrowest pixel filter that the engines have, in pixels.
NARROW = 0.01


class Shot(NamedTuple):
    """Passes by name, float32[height, width, channels], and the job's statistics."""
    passes: dict
    stats: dict

    @property
    def occlusion(self):
        """The AO pass as float64[height, width], 1 = open."""
        return self.passes["AO"][:, :, 0].astype(np.float64)

    def milliseconds(self, *prefixes):
        """Time of the passes whose names begin so, of all samples."""
        return sum(ms for name, ms in self.times().items() if name.startswith(prefixes))

    def times(self):
        """{pass: milliseconds}."""
        return {entry["name"]: entry["ms"] for entry in self.stats["passes"]}


class Stage:
    """A scene, opened anew; the file on disk stays as it is.

    size: width and height of all pictures; aspect: width over height in the file itself.
    """

    def __init__(self, path, size):
        register_once()
        self.path, self.size = Path(path), size
        self.open()

    def open(self):
        """Forgets every change of the scene."""
        with quiet():
            bpy.ops.wm.open_mainfile(filepath=str(self.path))
        self.scene = bpy.context.scene
        render = self.scene.render
        self.aspect = render.resolution_x / render.resolution_y
        render.resolution_x, render.resolution_y = self.size
        render.resolution_percentage = 100
        render.use_border = render.use_compositing = render.use_sequencer = False
        render.filter_size = NARROW
        self.scene.panoptes.noise_threshold = self.scene.panoptes.time_budget = 0.0
        if self.scene.world is None:
            self.scene.world = bpy.data.worlds.new("black")

    # --- ours -------------------------------------------------------------------------------------------

    def take(self, method, passes, samples, **settings):
        """Renders passes by 'realtime' or 'primitive'; `settings` are those of the request beside the scene's own."""
        from panoptes import requests, session
        self.scene.panoptes.method, self.scene.panoptes.samples = method, samples
        depsgraph = bpy.context.evaluated_depsgraph_get()
        request = requests.final(depsgraph, (), ignore)
        request["passes"] = list(passes)
        for name, value in settings.items():
            known = request["settings"].get(name)
            request["settings"][name] = {**known, **value} if isinstance(known, dict) else value
        with session.exclusive(wait=True):
            mirror = session.mirror()
            session.final_sync.sync(mirror, depsgraph, incremental=False)
            job = mirror.engine.render(request)
            while not job.wait(1.0):
                pass
            job.finish()
        return Shot({name: np.asarray(job.read(name)) for name in passes}, dict(job.stats()))

    # --- Cycles -----------------------------------------------------------------------------------------

    def take_with_cycles(self, passes, samples, bounces, width=NARROW):
        """Passes of Cycles, {name: float64[height, width, channels]}, each path scattered `bounces` times at most.

        passes: {name: its switch of the view layer}; width: of the pixel filter, in pixels.
        """
        scene, cycles = self.scene, self.scene.cycles
        scene.render.engine, cycles.device, cycles.samples = "CYCLES", "CPU", samples
        cycles.use_adaptive_sampling = cycles.use_denoising = False
        cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = bounces
        cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.light_sampling_threshold = 0.0
        cycles.pixel_filter_type, cycles.filter_width = "BLACKMAN_HARRIS", width
        for switch in passes.values():
            setattr(bpy.context.view_layer, switch, True)
        image = scene.render.image_settings
        if hasattr(image, "media_type"):  # since Blender 5.0 the format depends on it
            image.media_type = "MULTI_LAYER_IMAGE"
        image.file_format, image.color_depth = "OPEN_EXR_MULTILAYER", "32"
        with tempfile.TemporaryDirectory() as folder:
            scene.render.filepath = str(Path(folder) / "cycles.exr")
            with quiet():
                bpy.ops.render.render(write_still=True)
            found = images.read_passes(scene.render.filepath)
        scene.render.engine = "PANOPTES"
        return {name: found[name][::-1, :, :3].astype(np.float64) for name in passes}


def by_turns(named, take, repeat):
    """Renders named settings by turns: {name: [Shot, ...]} of `repeat` rounds, without the first one, which compiles."""
    shots = {name: [] for name in named}
    for turn in range(repeat + 1):
        for name, settings in named.items():
            shot = take(settings)
            if turn:
                shots[name].append(shot)
    return shots


def median_milliseconds(shots, *prefixes):
    """Of Shots, the median time of the passes whose names begin so."""
    return statistics.median(shot.milliseconds(*prefixes) for shot in shots)


@contextlib.contextmanager
def quiet():
    """Sends what Blender itself prints to nowhere: it is no part of the tables."""
    sys.stdout.flush()
    kept, nowhere = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    try:
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(nowhere)


def ignore(sentence):
    """What the artist would be told of the scene is no matter of a measurement."""


def register_once():
    """Makes the add-on known to Blender, the first time."""
    if "panoptes" not in sys.modules:
        register("PANOPTES")


def our_scene(name):
    """The path of one of our own scenes."""
    return ROOT / "blend_scenes" / f"{name}.blend"


def shared_scene(name):
    """The path of a third-party scene, which may not be there."""
    return ROOT.parent / "shared" / "scenes" / f"{name}.blend"
