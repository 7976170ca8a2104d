# SPDX-License-Identifier: GPL-3.0-or-later
"""Diffuse indirect light along paths, ours and Cycles', kept in build/bench-cache.

A picture's name there is a key of everything that it depends on: the scene's bytes, what renders it, the settings and
these scripts.
"""

import hashlib
import json
import re
from pathlib import Path

import bpy
import images
import numpy as np
import stage
from engines import ROOT

KEPT = ROOT / "build" / "bench-cache"
# Of the finished pictures beside the shared scenes.
FINISHED_BOUNCES = 8


class Reference(stage.Stage):
    """A scene at the largest size of its own shape that fits into `box`, (width, height)."""

    def __init__(self, path, box):
        self.box = box
        super().__init__(path, box)

    def open(self):
        super().open()
        width, height = self.box
        self.size = (min(width, round(height * self.aspect)), min(height, round(width / self.aspect)))
        self.scene.render.resolution_x, self.scene.render.resolution_y = self.size
        self.filter_width = self.scene.cycles.filter_width

    def paths(self, samples, bounces, moved=""):
        """DiffInd along our paths, float64[height, width, 3]; `moved` names what is no longer as in the file."""
        def make():
            shot = self.take("primitive", ("DiffInd",), samples, bounces=bounces, diffuse_bounces=bounces, glossy_bounces=bounces,
                             transmission_bounces=bounces, filter_glossy=0.0, noise_threshold=0.0)
            return shot.passes["DiffInd"][:, :, :3]
        key = {"engine": [_digest(module) for module in sorted((ROOT / "addon" / "panoptes").glob("panoptes_native*.so"))]}
        return self._kept(make, samples=samples, bounces=bounces, moved=moved, **key)

    def cycles(self, samples, bounces):
        """DiffInd along Cycles' paths, float64[height, width, 3]."""
        def make():
            self.scene.cycles.blur_glossy = 0.0
            return self.take_with_cycles({"DiffInd": "use_pass_diffuse_indirect"}, samples, bounces)["DiffInd"]
        return self._kept(make, engine=bpy.app.version_string, samples=samples, bounces=bounces)

    def finished(self, samples):
        """Combined of Cycles, rows from the top: the shared picture where there is one of this size, else one of our own."""
        shared = self.path.parent / "reference" / f"{self.path.stem}.exr"
        if shared.is_file():
            found = images.read_pass(shared)
            if found.shape[1::-1] == tuple(self.size):
                return found

        def make():
            return self.take_with_cycles({"Combined": "use_pass_combined"}, samples, FINISHED_BOUNCES, width=self.filter_width)["Combined"]
        return self._kept(make, engine=bpy.app.version_string, samples=samples, bounces=FINISHED_BOUNCES, width=self.filter_width)[::-1]

    def _kept(self, make, **key):
        """float64[height, width, 3] of make(), from the disk where it is there."""
        key.update(scene=_digest(self.path), size=self.size, frame=self.scene.frame_current, script=[_digest(Path(__file__)), _digest(Path(stage.__file__))])
        name = hashlib.sha256(json.dumps(key, sort_keys=True).encode()).hexdigest()[:24]
        path = KEPT / f"{re.sub(r'[^A-Za-z0-9_]', '-', self.path.stem)}-{name}.npy"
        if not path.is_file():
            KEPT.mkdir(parents=True, exist_ok=True)
            # Written elsewhere first: an interrupted run leaves nothing that looks finished.
            made = path.with_suffix(".part.npy")
            np.save(made, np.asarray(make(), np.float32))
            made.replace(path)
        return np.load(path).astype(np.float64)


def _digest(path):
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()
