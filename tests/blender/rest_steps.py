# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender with a window: a 3D View at rest, files opened one after the other, and an end in between.

-- OUT.json rest            how much of a processor a finished 3D View takes, in Solid shading and rendered
-- OUT.json files FILE...   each opened in turn, and rendered in the 3D View
-- OUT.json quit            Blender ends while a 3D View and the engine are at work
"""

import os
import sys
import time

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from window_steps import area, mean, nothing, pictures, run, viewports  # noqa: E402

import panoptes  # noqa: E402
from panoptes import native  # noqa: E402

# Seconds for which a resting view is watched.
WATCHED = 3.0
_watch = {}


def rendered():
    """Show the scene by Panoptes in a small picture."""
    scene = bpy.context.scene
    scene.render.engine = 'PANOPTES'
    scene.panoptes.method = 'realtime'
    scene.panoptes.viewport_samples = 2
    scene.panoptes.realtime.shadow_resolution = 64
    area('VIEW_3D').spaces[0].shading.type = 'RENDERED'


def start():
    """Blender's first scene, rendered."""
    panoptes.register()
    rendered()


def seen():
    """Return the mean colour of the finished picture."""
    found = pictures()
    return found and mean(found[0])


def watch():
    """Begin to watch what the process takes of the processors."""
    _watch.update(wall=time.monotonic(), processor=time.process_time())


def taken():
    """Return the share of a processor that was taken; None while too little time has passed."""
    wall = time.monotonic() - _watch['wall']
    return (time.process_time() - _watch['processor']) / wall if wall > WATCHED else None


def solid():
    """Leave Rendered shading."""
    area('VIEW_3D').spaces[0].shading.type = 'SOLID'


def opening(path):
    """Return an action that opens a file and shows it in the view that is there."""
    def act():
        bpy.ops.wm.open_mainfile(filepath=path, load_ui=False)
        rendered()
    return act


def opened():
    """Return the mean colour of the finished picture, and the bytes that are kept for it on the graphics card."""
    found = seen()
    return found and {'color': found[:3], 'memory': native.engine().counters()['memory_bytes']}


def endless():
    """Let paths be traced without end."""
    settings = bpy.context.scene.panoptes
    settings.method, settings.viewport_samples = 'primitive', 100000
    # Blender does this itself when the artist chooses in the panel, but not for scripts.
    area('VIEW_3D').tag_redraw()


def tracing():
    """Return how many samples there are as soon as paths are under way."""
    view = viewports()
    stage = view and view[0]._picture.stage
    return stage.samples if stage and stage.method == 'primitive' and stage.samples else None


def steps(kind, words):
    """Return the steps of a kind."""
    if kind == 'rest':
        return [('start', start, seen), ('settled', nothing, nothing), ('rendered', watch, taken),
                ('to solid', solid, nothing), ('solid', watch, taken)]
    if kind == 'files':
        return [('start', start, seen), *((f'{n} {os.path.basename(path)}', opening(path), opened)
                                          for n, path in enumerate(words))]
    return [('start', start, seen), ('paths', endless, tracing)]


def main():
    """Do what the command line asks for."""
    kind, *words = sys.argv[sys.argv.index('--') + 2:]
    run(steps(kind, words), close=kind != 'quit')


main()
