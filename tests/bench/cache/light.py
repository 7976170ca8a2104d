# SPDX-License-Identifier: GPL-3.0-or-later
"""Diffuse indirect light of a scene: from the radiance cache, along our paths and along Cycles'.

What is compared is DiffInd, and DiffInd times the colour of surfaces, which is what arrives at the camera. The colour
is that of our own first surfaces for all, so that nothing but light differs. References are kept in build/bench-cache
under a key of everything that they depend on.
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
SCENES = ("cornell", "sponza_crytek", "canyon", "two_spots", "doorway")
# Of the finished pictures beside the shared scenes.
FINISHED_BOUNCES = 8
# Effects whose passes are the cache's; their names begin so. What makes voxels is told apart, as in Table 5.1.
CACHE, VOXELS = ("radiance_cache", "cache_"), ("radiance_cache_voxels",)


class Light(stage.Stage):
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

    def cached(self, samples, passes=("DiffInd",), **settings):
        """A Shot of Real-time; `settings` as in settings['cache'] of a request."""
        return self.take("realtime", passes, samples, cache=settings)

    def colour(self):
        """DiffCol of the first surfaces, float64[height, width, 3]."""
        return self.take("realtime", ("DiffCol",), 1).passes["DiffCol"].astype(np.float64)

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


def paths_of(options, names=SCENES):
    """The scenes to measure: that of the options, else those of these names; a sentence for each that is not there."""
    paths = [options.scene] if options.scene else [
        stage.our_scene(name) if stage.our_scene(name).is_file() else stage.shared_scene(name) for name in names]
    for path in paths:
        if not path.is_file():
            print(f"{path.name} is not beside this checkout; it is left out.\n")
    return [path for path in paths if path.is_file()]


def cache_milliseconds(shots):
    """Median time of the cache's passes without what makes voxels."""
    return stage.median_milliseconds(shots, *CACHE) - stage.median_milliseconds(shots, *VOXELS)
