# SPDX-License-Identifier: GPL-3.0-or-later
"""Diffuse indirect light of a scene from the radiance cache, beside that of paths.

What is compared is DiffInd, and DiffInd times the colour of surfaces, which is what arrives at the camera. The colour
is that of our own first surfaces for all, so that nothing but light differs.
"""

import numpy as np
import stage
from reference import Reference

SCENES = ("cornell", "sponza_crytek", "canyon", "two_spots", "doorway")
# Effects whose passes are the cache's; their names begin so. What makes voxels is told apart, as in Table 5.1.
CACHE, VOXELS = ("radiance_cache", "cache_"), (
    "radiance_cache_voxels", "radiance_cache_surfels", "radiance_cache_seeds", "radiance_cache_reach")


class Light(Reference):
    """A scene whose indirect light is in a cache."""

    def cached(self, samples, passes=("DiffInd",), **settings):
        """A Shot of Real-time; `settings` as in settings['cache'] of a request."""
        return self.take("realtime", passes, samples, cache=settings)

    def diffuse(self, samples, **settings):
        """DiffInd of Real-time, float64[height, width, 3]; `settings` as of cached()."""
        return self.cached(samples, **settings).passes["DiffInd"][:, :, :3].astype(np.float64)

    def clipped(self, **settings):
        """Share of the cache's light, that of the world with it, which is cut off where harmonics ring below 0."""
        light, share = (self.take("realtime", ("Combined",), 1, cache={**settings, "picture": picture}).passes["Combined"].astype(np.float64)
                        for picture in ("light", "clipped"))
        light, share = light[:, :, :3].sum(axis=2), share[:, :, 0]
        # Where nothing is left, the share does not tell of how much; the mean is more than it is likely to be.
        cut = np.where(light > 0.0, light, light.mean()) * share
        return float(cut.sum() / light.sum()) if light.any() else 0.0

    def colour(self):
        """DiffCol of the first surfaces, float64[height, width, 3]."""
        return self.take("realtime", ("DiffCol",), 1).passes["DiffCol"].astype(np.float64)


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


def as_written(encoding):
    """The encoding as the dissertation writes it, "Y3Co1Cg1"."""
    return encoding.upper().replace("CO", "Co").replace("CG", "Cg")


def stage_of(name):
    """What a pass of the cache is called in a figure."""
    return name.removeprefix(CACHE[0]).removeprefix(CACHE[1]).strip("_").replace("_", " ")
