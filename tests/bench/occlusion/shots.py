# SPDX-License-Identifier: GPL-3.0-or-later
"""The occlusion of a scene under the camera of the bench, by views, by our rays and by Cycles."""

import bpy
import numpy as np
import relight
from stage import Stage

# Of the scene's box: how far occluders are looked for where nothing else is said.
DISTANCE_SHARE = 0.025
# Cycles gives the background a depth of 1e10 m, we do of the kind.
FARTHEST = 1e9
# Less light than this is none, W/m^2 per steradian: what single precision leaves of an N.L of 0.
UNLIT = 1e-4
SUN_WATTS = 3.0
# A view and pixel: six slices of four for HBAO, whatever is asked for, and what the others are asked for here.
HBAO_SAMPLES, POINT_SAMPLES = 24, 15


class Shots(Stage):
    """A scene, opened anew; the file on disk stays as it is."""

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

    def trace_with_cycles(self, samples, distance):
        """Cycles' AO pass, float64[height, width]."""
        self.scene.world.light_settings.distance = distance
        return self.take_with_cycles({"AO": "use_pass_ambient_occlusion"}, samples, 0)["AO"][:, :, 0]


def share_of(heat):
    """From the colours of a picture of samples to what they stand for, 1/8 to 7/8; whole red is 1. float[..., channels]"""
    red, green, blue = heat[..., 0], heat[..., 1], heat[..., 2]
    return np.select([(green < 1.0) & (blue > red), green >= 1.0, green > 0.0], [0.125 + 0.25 * green, 0.5 + 0.25 * (red - blue), 0.875 - 0.25 * green], 1.0)
