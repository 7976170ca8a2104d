# SPDX-License-Identifier: GPL-3.0-or-later
"""The pictures that 3D Views should show: of engines that have never seen the scene before."""

import bpy
import numpy as np

from panoptes import changeover, native, refinement, requests, session
from panoptes.sync import Mirror, SceneSync
from panoptes.viewport import _key

# One pixel of a picture covers so many by so many of the region, so that pictures are soon done.
PIXEL = 4
# The least side of blocks of pixels whose means are compared where single ones depend on the order in which a scene is
# sent.
BLOCK = 20


def note_jobs(noted):
    """Append every refinement of a 3D View to `noted` when a job of it starts."""
    start = refinement.Refinement.start

    def started(self, engine):
        noted.append(self)
        start(self, engine)

    refinement.Refinement.start = started


def rendered_spaces():
    """Return (space, region) of each 3D View in Rendered shading."""
    screen = bpy.context.window_manager.windows[0].screen
    return [(a.spaces[0], next(r for r in a.regions if r.type == 'WINDOW')) for a in screen.areas
            if a.type == 'VIEW_3D' and a.spaces[0].shading.type == 'RENDERED']


def request_of(space, region):
    """Return what a 3D View should show now."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    return requests.viewport(depsgraph, region, space.region_3d, space, PIXEL, lambda sentence: None)[0]


def shown(request):
    """Return what is behind the 3D View that shows a request's view in full; None while none does."""
    wanted = _key(request, None)[1]
    for viewport in list(session.viewports):
        complete = viewport._picture is not None and not viewport.is_rendering() and viewport._pixels is not None
        if complete and viewport._key[1] == wanted:
            return viewport
    return None


def picture(request, space):
    """Return float32[H, W, 4] of a new engine, with a GL context of its own, that is sent everything."""
    engine = native.module().Engine()
    try:
        SceneSync().sync(Mirror(engine), bpy.context.evaluated_depsgraph_get(), space, incremental=False)
        job = engine.render(request)
        while not job.wait(1.0):
            pass
        job.finish()
        return job.read('Combined')
    finally:
        engine.close()


def pixels_of(viewport):
    """Return what a 3D View has rendered by its request: of a picture that changes over to paths, the paths' own."""
    picture = viewport._picture
    return picture._paths.pixels if isinstance(picture, changeover.Changeover) else viewport._pixels


def apart(pixels, expected):
    """Return by how much the mean of any block differs, as a share of its light or a tenth of the picture's."""
    found, wanted = block_means(pixels), block_means(expected)
    return float((np.abs(found - wanted) / np.maximum(np.abs(wanted), 0.1 * np.abs(wanted).mean())).max())


def block_means(pixels):
    """Return the means of the blocks of a picture, RGB: at least one, and all of about the same size."""
    height, width = pixels.shape[:2]
    rows = np.array_split(pixels[..., :3], max(height // BLOCK, 1), axis=0)
    return np.array([block.mean(axis=(0, 1)) for row in rows
                     for block in np.array_split(row, max(width // BLOCK, 1), axis=1)])


def difference(shown_pixels, request, space):
    """Return how a view's picture differs from a fresh one: in how many pixels and by how much, and `apart` in blocks."""
    expected = picture(request, space)
    if expected.shape != shown_pixels.shape:
        return {'size': shown_pixels.shape[:2], 'differing': expected.shape[0] * expected.shape[1], 'largest': None,
                'apart': float('inf')}
    off = np.abs(shown_pixels - expected).max(axis=2)
    return {'size': expected.shape[:2], 'differing': int((off != 0.0).sum()), 'largest': float(off.max()),
            'mean': float(np.abs(expected[..., :3]).mean()), 'apart': apart(shown_pixels, expected)}
