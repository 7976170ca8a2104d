# SPDX-License-Identifier: GPL-3.0-or-later
"""Animations of deforming meshes: what is kept from frame to frame never shows.

Each frame is synchronised by change into one engine, and rendered; the same frame is read afresh
into a new engine, and has to give the same bits. The scenes lie beside the checkout, if anywhere.
"""

import os

import bpy
import numpy as np
import pytest

from conftest import ROOT
from panoptes import requests
from panoptes.sync import Mirror, SceneSync

SCENES = os.path.join(os.path.dirname(ROOT), 'shared', 'scenes')
# Neighbours, and in the end a long jump and the way back.
FRAMES = (1, 2, 24, 3) if os.environ.get('PANOPTES_TEST_FAST') else (*range(1, 25), 9, 1)
PASSES = ('Combined', 'Depth', 'Normal')


def picture(engine, depsgraph):
    """Render what an engine holds; float32[H, W, C] of all passes side by side."""
    request = requests.final(depsgraph, PASSES, pytest.fail)
    request['passes'] = list(PASSES)
    job = engine.render(request)
    while not job.wait(60.0):
        pass
    job.finish()
    return np.concatenate([job.read(name) for name in PASSES], axis=2)


@pytest.fixture
def play(native_module):
    """A function that plays frames of a file; yields (frame, picture by change, picture afresh,
    report of the synchronisation by change)."""
    engine = native_module.Engine(True)

    def frames_of(name, frames):
        path = os.path.join(SCENES, f'{name}.blend')
        if not os.path.isfile(path):
            pytest.skip(f'needs {name}.blend, in shared/scenes beside the checkout')
        bpy.ops.wm.open_mainfile(filepath=path)
        scene = bpy.context.scene
        scene.render.engine = 'PANOPTES'
        scene.render.resolution_x, scene.render.resolution_y = 96, 54
        scene.render.resolution_percentage = 100
        scene.panoptes.samples = 1
        mirror, scene_sync = Mirror(engine), SceneSync()
        reports = []

        def follow(_scene, depsgraph):
            reports.append(scene_sync.sync(mirror, depsgraph, incremental=bool(reports)))

        bpy.app.handlers.frame_change_post.append(follow)
        try:
            for frame in frames:
                scene.frame_set(frame)
                depsgraph = bpy.context.evaluated_depsgraph_get()
                kept = picture(engine, depsgraph)
                other = native_module.Engine(True)
                try:
                    SceneSync().sync(Mirror(other), depsgraph, incremental=False)
                    fresh = picture(other, depsgraph)
                finally:
                    other.close()
                yield frame, kept, fresh, reports[-1]
        finally:
            bpy.app.handlers.frame_change_post.remove(follow)

    yield frames_of
    engine.close()


@pytest.mark.parametrize('name, meshes', [('fox_skinned', 2), ('igea_deform', 3)])
def test_frames_by_change_equal_fresh_ones(play, name, meshes):
    last = None
    for frame, kept, fresh, report in play(name, FRAMES):
        assert np.array_equal(kept, fresh, equal_nan=True), f'frame {frame}'
        assert np.isfinite(kept).all()
        # One mesh deforms; nothing else is read again.
        assert report.meshes_extracted == (meshes if last is None else 1)
        assert last is None or not np.array_equal(kept, last)
        last = kept
