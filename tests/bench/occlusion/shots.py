# SPDX-License-Identifier: GPL-3.0-or-later
"""One scene under the camera of the bench: passes of our methods as arrays, and Cycles' occlusion.

Ours are asked for from the native engine itself, so that a picture costs no file and one synchronisation serves many.
All look through the pixels' centres (the narrowest filter that there is), so that every method sees the same first
surfaces and pictures differ by their occlusion alone. Rows are from the bottom up, as the engine gives them.
"""

import contextlib
import os
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

import bpy
import images
import numpy as np
import relight
from engines import ROOT, register

# Of the scene's box: how far occluders are looked for where nothing else is said.
DISTANCE_SHARE = 0.025
# The narrowest pixel filter that the engines have, in pixels.
NARROW = 0.01
# Cycles gives the background a depth of 1e10 m, we do of the kind.
FARTHEST = 1e9
# Less light than this is none, W/m^2 per steradian: what single precision leaves of an N.L of 0.
UNLIT = 1e-4
SUN_WATTS = 3.0
# A view and pixel: six slices of four for HBAO, whatever is asked for, and what the others are asked for here.
HBAO_SAMPLES, POINT_SAMPLES = 24, 15


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


class Shots:
    """A scene, opened anew; the file on disk stays as it is."""

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
        render.resolution_x, render.resolution_y = self.size
        render.resolution_percentage = 100
        render.use_border = render.use_compositing = render.use_sequencer = False
        render.filter_size = NARROW
        self.scene.panoptes.noise_threshold = self.scene.panoptes.time_budget = 0.0
        if self.scene.world is None:
            self.scene.world = bpy.data.worlds.new("black")

    def default_distance(self):
        """DISTANCE_SHARE of the diagonal of the box around all meshes, metres."""
        corners = np.array([made.matrix_world @ type(made.location)(corner) for made in self.scene.objects
                            if made.type == "MESH" and not made.hide_render for corner in made.bound_box])
        return DISTANCE_SHARE * float(np.linalg.norm(corners.max(axis=0) - corners.min(axis=0)))

    def lamp_count(self):
        """Lamps that cast shadows."""
        return sum(made.type == "LIGHT" and not made.hide_render and made.data.use_shadow for made in self.scene.objects)

    def add_sun(self, turn=0.7):
        """Adds a sun that is 50 degrees high, `turn` radians from the camera's right."""
        light = bpy.data.lights.new("added sun", "SUN")
        light.energy = SUN_WATTS
        made = bpy.data.objects.new("added sun", light)
        made.rotation_euler = (0.7, 0.0, self.scene.camera.matrix_world.to_euler().z + turn)
        self.scene.collection.objects.link(made)

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

    def estimate(self, samples, distance, passes=("AO",), **occlusion):
        """The occlusion that views tell, without filter; `occlusion` as in settings['occlusion'] of a request."""
        return self.take("realtime", passes, samples, occlusion={"distance": distance, "filter": "off", "samples": POINT_SAMPLES, **occlusion})

    def samples_taken(self, distance, **occlusion):
        """Samples that one sample of the film takes of all views together, the mean over all surfaces.

        Read from the pictures of it: how many views there are from that of their weights, which shows three, and
        the share of the samples that they may take from the colours of the other.
        """
        shown = {picture: self.estimate(1, distance, ("Combined",), **occlusion, picture=picture).passes["Combined"].astype(np.float64)
                 for picture in ("weights", "samples")}
        views = sum(shown["weights"][:, :, channel].max() > 0.0 for channel in range(3))
        surfaces = shown["weights"][:, :, :3].max(axis=2) > 0.0
        most = HBAO_SAMPLES if occlusion["estimator"] == "hbao" else POINT_SAMPLES
        return views * most * float(share_of(shown["samples"])[surfaces].mean())

    def trace(self, samples, distance):
        """The occlusion that rays tell."""
        self.scene.panoptes.bounces = 0
        return self.take("primitive", ("AO",), samples, ao_distance=distance).occlusion

    def surfaces(self):
        """Where a surface is seen, bool[height, width], and its distance along the camera's axis in metres."""
        depth = self.take("realtime", ("Depth",), 1).passes["Depth"][:, :, 0].astype(np.float64)
        return depth < FARTHEST, depth

    def lit(self):
        """Where a lamp's light arrives, bool[height, width]: the region that lamps' shadow maps cover. Changes the scene."""
        relight.by_lamps(self.scene)
        return self.take("realtime", ("DiffDir",), 1).passes["DiffDir"].max(axis=2) > UNLIT

    # --- Cycles -----------------------------------------------------------------------------------------

    def trace_with_cycles(self, samples, distance):
        """Cycles' AO pass, float64[height, width]."""
        scene, cycles = self.scene, self.scene.cycles
        scene.render.engine, cycles.device, cycles.samples = "CYCLES", "CPU", samples
        cycles.use_adaptive_sampling = cycles.use_denoising = False
        cycles.max_bounces, cycles.pixel_filter_type, cycles.filter_width = 0, "BLACKMAN_HARRIS", NARROW
        scene.world.light_settings.distance = distance
        bpy.context.view_layer.use_pass_ambient_occlusion = True
        image = scene.render.image_settings
        if hasattr(image, "media_type"):  # since Blender 5.0 the format depends on it
            image.media_type = "MULTI_LAYER_IMAGE"
        image.file_format, image.color_depth = "OPEN_EXR_MULTILAYER", "32"
        with tempfile.TemporaryDirectory() as folder:
            scene.render.filepath = str(Path(folder) / "cycles.exr")
            with quiet():
                bpy.ops.render.render(write_still=True)
            occlusion = images.read_pass(scene.render.filepath, "AO")[::-1, :, 0]
        scene.render.engine = "PANOPTES"
        return occlusion.astype(np.float64)


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


def share_of(heat):
    """From the colours of a picture of samples to what they stand for, 1/8 to 7/8; whole red is 1. float[..., channels]"""
    red, green, blue = heat[..., 0], heat[..., 1], heat[..., 2]
    return np.select([(green < 1.0) & (blue > red), green >= 1.0, green > 0.0], [0.125 + 0.25 * green, 0.5 + 0.25 * (red - blue), 0.875 - 0.25 * green], 1.0)


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
