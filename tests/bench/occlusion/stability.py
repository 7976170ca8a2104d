# SPDX-License-Identifier: GPL-3.0-or-later
"""How much the occlusion of points that rest changes while the camera moves.

Points of the surfaces are taken from some frames of the scene's animation, and looked up in every frame in which all
four pixels around them show the same place of the same surface; between those the occlusion is interpolated. A point's
standard deviation over time would be 0 for occlusion that does not depend on the view. Every frame has the same seed and
sample numbers, so that noise is no more than that of one picture. Rays tell what remains of noise and interpolation.
"""

import bpy
import numpy as np
import tables
import variants
from shots import FARTHEST, Shots
from stage import our_scene

# Points are taken from this many frames, spread over the animation, and from every third pixel each way.
SOURCES, STRIDE = 5, 3
# Seen in fewer frames, a point says little about time.
LEAST_SHARE = 0.3
# How far, as a share of the range of occlusion, the four pixels may lie from the point's plane: beyond that they show
# another surface. And how nearly they must face as it does.
OFF_PLANE, SAME_FACING = 0.05, 0.95
# Rays are slow: they trace about so many of the frames.
TRACED = 10
_FORMATS = {"deviation": ".4f", "steadier": ".2f", "worst tenth": ".4f", "points": "d", "frames": "d"}


class Frame:
    """What the camera sees in one frame: positions and normals of the pixels' centres, and how points project."""

    def __init__(self, shots, number):
        shots.scene.frame_set(number)
        passes = shots.take("realtime", ("Depth", "Normal"), 1).passes
        self.depth, self.normal = passes["Depth"][:, :, 0].astype(np.float64), passes["Normal"].astype(np.float64)
        self.width, self.height = shots.size
        camera, depsgraph = shots.scene.camera, bpy.context.evaluated_depsgraph_get()
        self.view = np.linalg.inv(np.array(camera.matrix_world.normalized(), np.float64))
        self.projection = np.array(camera.calc_matrix_camera(depsgraph, x=self.width, y=self.height), np.float64)
        self.position = self._positions()

    def _positions(self):
        """World positions float64[height, width, 3] of the pixels' centres, by their depths along the axis."""
        y, x = np.mgrid[:self.height, :self.width]
        device = np.stack([(x + 0.5) / self.width * 2.0 - 1.0, (y + 0.5) / self.height * 2.0 - 1.0,
                           np.zeros_like(x, float), np.ones_like(x, float)], axis=-1)
        ray = device @ np.linalg.inv(self.projection).T
        ray = ray[..., :3] / ray[..., 3:]
        seen = ray / -ray[..., 2:] * np.minimum(self.depth, FARTHEST)[..., None]
        world = np.concatenate([seen, np.ones((self.height, self.width, 1))], axis=-1) @ np.linalg.inv(self.view).T
        return world[..., :3]

    def surfels(self):
        """(positions float64[N, 3], normals float64[N, 3]) of every STRIDE-th pixel that shows a surface."""
        rows = slice(STRIDE // 2, None, STRIDE)
        shown = self.depth[rows, rows] < FARTHEST
        return self.position[rows, rows][shown], self.normal[rows, rows][shown]

    def find(self, points, normals, reach):
        """Where points are in the picture.

        reach: how far a pixel's position may lie off a point's plane, metres. Returns (found bool[N], pixels int[N, 4] in
        row-major order, weights float64[N, 4]); what is not found has pixel 0.
        """
        eye = np.concatenate([points, np.ones((len(points), 1))], axis=1) @ self.view.T
        clip = eye @ self.projection.T
        found = clip[:, 3] > 1e-6
        w = np.where(found, clip[:, 3], 1.0)
        x = (clip[:, 0] / w * 0.5 + 0.5) * self.width - 0.5
        y = (clip[:, 1] / w * 0.5 + 0.5) * self.height - 0.5
        found &= (x >= 0.0) & (y >= 0.0) & (x < self.width - 1) & (y < self.height - 1)
        x, y = np.where(found, x, 0.0), np.where(found, y, 0.0)
        left, low = x.astype(int), y.astype(int)
        right, up = x - left, y - low
        pixels = np.stack([low * self.width + left, low * self.width + left + 1,
                           (low + 1) * self.width + left, (low + 1) * self.width + left + 1], axis=1)
        pixels = np.where(found[:, None], pixels, 0)
        weights = np.stack([(1 - right) * (1 - up), right * (1 - up), (1 - right) * up, right * up], axis=1)
        off = np.abs(((self.position.reshape(-1, 3)[pixels] - points[:, None]) * normals[:, None]).sum(axis=2))
        facing = (self.normal.reshape(-1, 3)[pixels] * normals[:, None]).sum(axis=2)
        same = (off < reach) & (facing > SAME_FACING) & (self.depth.reshape(-1)[pixels] < FARTHEST)
        return found & same.all(axis=1), pixels, weights


class Track:
    """Sums over time of what points look like."""

    def __init__(self, count):
        self.number, self.sum, self.squares = np.zeros(count, int), np.zeros(count), np.zeros(count)

    def add(self, occlusion, found, pixels, weights):
        """Adds a frame's picture."""
        value = (occlusion.reshape(-1)[pixels] * weights).sum(axis=1)
        self.number += found
        self.sum += np.where(found, value, 0.0)
        self.squares += np.where(found, value**2, 0.0)

    def deviations(self, frames):
        """Standard deviations of the points that are seen in LEAST_SHARE of so many frames and in at least 2."""
        often = self.number >= max(2, LEAST_SHARE * frames)
        number = self.number[often]
        variance = (self.squares[often] - self.sum[often] ** 2 / number) / (number - 1)
        return np.sqrt(np.maximum(variance, 0.0))


def row(track, frames):
    """What the table shows of one way to find occlusion."""
    deviations = track.deviations(frames)
    if not len(deviations):
        return {"points": 0, "frames": frames}
    return {"deviation": float(np.sqrt(np.mean(deviations**2))), "worst tenth": float(np.quantile(deviations, 0.9)),
            "points": len(deviations), "frames": frames}


def measure(path, options):
    """The deviations of each estimator's single and multiview occlusion, and of rays."""
    shots = Shots(path, options.pixels)
    distance = options.distance or shots.default_distance()
    scene = shots.scene
    numbers = list(range(scene.frame_start, scene.frame_end + 1, options.every))
    sources = numbers[::max(1, len(numbers) // SOURCES)]
    points, normals = (np.concatenate(parts) for parts in zip(*(Frame(shots, number).surfels() for number in sources)))
    names = {(estimator, name): settings for estimator in options.estimators
             for name, settings in variants.variants(estimator).items()
             if name in (variants.SINGLE, variants.LAMPS, variants.LAMPS_IS)}
    tracks = {name: Track(len(points)) for name in names}
    rays, traced = Track(len(points)), 0
    for index, number in enumerate(numbers):
        frame = Frame(shots, number)
        where = frame.find(points, normals, OFF_PLANE * distance)
        for name, settings in names.items():
            tracks[name].add(shots.estimate(options.samples, distance, **settings).occlusion, *where)
        if index % max(1, len(numbers) // TRACED) == 0:
            traced += 1
            rays.add(shots.trace(options.reference_samples, distance), *where)
    rows = {"rays": row(rays, traced)}
    for (estimator, name), track in tracks.items():
        found = rows[f"{estimator} {name}"] = row(track, len(numbers))
        single = rows[f"{estimator} {variants.SINGLE}"]
        if name != variants.SINGLE and found.get("deviation"):
            found["steadier"] = single["deviation"] / found["deviation"]
    return {"scene": path.stem, "distance": distance, "rows": rows}


def run(options):
    """Measures and prints; returns what was found."""
    found = measure(options.scene or our_scene("colonnade"), options)
    tables.show(f"stability: {found['scene']}, {options.size}, {options.samples} samples of the film, range {found['distance']:.2f} m; "
                "standard deviation over time, root mean square of all points", found["rows"], _FORMATS)
    return found
