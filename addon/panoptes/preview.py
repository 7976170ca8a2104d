# SPDX-License-Identifier: GPL-3.0-or-later
"""Previews of materials, worlds, lamps and textures: icons and the panels called Preview.

Blender renders them in threads of their own, from a small scene that it keeps for the purpose, and
while the artist works on. They have a native engine of their own, so that neither a 3D View nor a
final render loses its scene to them; nobody waits for them, and none of their failures is reported.
"""

import threading

from . import native, requests
from .results import LayerResult
from .sync import Mirror, SceneSync

# Held by the preview that renders; Blender may start the next before the last has ended.
_lock = threading.Lock()
_mirror = None


def _current_mirror():
    global _mirror
    engine = native.engine('preview')
    if _mirror is None or _mirror.engine is not engine:
        _mirror = Mirror(engine)
    return _mirror


def render(engine, depsgraph):
    """Render a preview for `engine`; raises what the sync and the native module raise."""
    while not _lock.acquire(timeout=0.05):
        if engine.test_break():
            return
    try:
        _render(engine, depsgraph)
    finally:
        _lock.release()


def _render(engine, depsgraph):
    request = requests.preview(depsgraph)
    mirror = _current_mirror()
    # Each preview is another scene: nothing that is known of the last one holds, but what happens to
    # be the same (the sphere, the floor) is not sent again.
    SceneSync().sync(mirror, depsgraph, incremental=False)
    result = LayerResult(engine, depsgraph.view_layer.name, (request['width'], request['height']))
    finished = False
    try:
        job = mirror.engine.render(request)
        while not job.wait(0.02):
            if engine.test_break():
                job.cancel()
        job.finish()
        finished = job.samples_ready() > 0
        if finished:
            result.fill(job, ('Combined',))
    finally:
        result.end(cancel=not finished)
