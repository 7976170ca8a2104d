# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender with a window: edits the scene of a rendered 3D View and times what the view shows of it.

blender --factory-startup -P window.py -- JOB.json

The job is a dictionary: scene, engine, samples, edits (a number of them), kind ('move', 'frame', or 'play': the animation
is played), out, a folder, and screen, the file in which the virtual display keeps its screen. What stands there counts, so
engines are measured alike, whatever they tell: an edit has arrived in full when the picture changes no more.
"""

import json
import mmap
import os
import struct
import sys
import time
import traceback
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import engines  # noqa: E402

# A picture that has not changed for so many seconds is finished; one that still does after the limit never will be. The
# first one may rest for longer in between, while programs are compiled.
QUIET, FIRST_QUIET, LIMIT = 2.0, 8.0, 120.0
POLL = 0.02
# How long an animation is played, and for how long before that without being measured.
PLAYED, WARM_UP = 12.0, 4.0
MOVE_METRES = 0.01


def view():
    """Return the window's 3D View, an area."""
    return next(a for a in bpy.context.window_manager.windows[0].screen.areas if a.type == 'VIEW_3D')


class Screen:
    """The virtual display's screen, which it keeps in a file in the format of xwd."""

    def __init__(self, path):
        with open(path, 'rb') as file:
            self._bytes = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
        header = struct.unpack('>25I', self._bytes[:100])
        colors, (width, height), line = header[19], header[4:6], header[12]
        if header[11] != 32:
            raise ValueError(f'the display has {header[11]} bits a pixel instead of 32')
        self._pixels = np.frombuffer(self._bytes, np.uint8, line * height, header[0] + 12 * colors)
        self._pixels = self._pixels.reshape(height, line)[:, :4 * width].reshape(height, width, 4)

    def region(self):
        """Return what the 3D View shows now, uint8[H, W, 3], row 0 at the bottom."""
        region = next(r for r in view().regions if r.type == 'WINDOW')
        bottom_up = self._pixels[::-1, :, 2::-1]
        return bottom_up[region.y:region.y + region.height, region.x:region.x + region.width].copy()


class Watch:
    """What the 3D View has shown, and when."""

    def __init__(self, screen):
        self.screen = screen
        self.picture = None
        self.first = self.last = self.since = 0.0
        self.pictures = 0

    def look(self):
        """Note the picture if it is another."""
        found = self.screen.region()
        if self.picture is not None and np.array_equal(found, self.picture):
            return
        now = time.perf_counter()
        self.picture, self.last, self.pictures = found, now, self.pictures + 1
        self.first = self.first or now

    def begin(self):
        """Forget when, but not what."""
        self.since, self.first, self.last, self.pictures = time.perf_counter(), 0.0, 0.0, 0

    def finished(self, quiet=QUIET):
        """Tell whether the picture has changed, and has not done so for `quiet` seconds."""
        self.look()
        now = time.perf_counter()
        if now - self.since > LIMIT:
            raise TimeoutError('the 3D View does not come to rest')
        return self.last > 0.0 and now - self.last > quiet


def prepare(job):
    """Open the scene in the window that is there, and render it in its 3D View."""
    bpy.ops.wm.open_mainfile(filepath=job['scene'], load_ui=False)
    scene = bpy.context.scene
    engines.choose(scene, job['engine'], (scene.render.resolution_x, scene.render.resolution_y))
    scene.view_settings.view_transform = 'Standard'
    if job['engine'] == 'CYCLES':
        scene.cycles.preview_samples = job['samples']
        scene.cycles.use_preview_adaptive_sampling = scene.cycles.use_preview_denoising = False
    else:
        scene.panoptes.viewport_samples = job['samples']
    space = view().spaces[0]
    space.overlay.show_overlays = space.show_gizmo = False
    space.region_3d.view_perspective = 'CAMERA'
    space.shading.type = 'RENDERED'
    view().tag_redraw()


def edit(job, number):
    """Move the scene's first mesh there or back, or go on to the next frame."""
    scene = bpy.context.scene
    if job['kind'] == 'frame':
        scene.frame_set(scene.frame_start + 1 + number)
        return
    moved = next(thing for thing in scene.objects if thing.type == 'MESH')
    moved.location.x += MOVE_METRES * (1 if number % 2 == 0 else -1)


def edits(job, watch, found):
    """Make one edit after the other, each when the view rests; yield while Blender has to go on."""
    for number in range(job['edits']):
        watch.begin()
        edit(job, number)
        while not watch.finished():
            yield
        found.append({'first': watch.first - watch.since, 'full': watch.last - watch.since})


def play(watch, found):
    """Play the animation, every frame of it; yield while Blender has to go on."""
    bpy.context.scene.sync_mode = 'NONE'
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window, area=view()):
        bpy.ops.screen.animation_play()
    for seconds in (WARM_UP, PLAYED):
        watch.begin()
        while time.perf_counter() - watch.since < seconds:
            watch.look()
            yield
    found.append({'pictures': watch.pictures, 'seconds': time.perf_counter() - watch.since})
    with bpy.context.temp_override(window=window, area=view()):
        bpy.ops.screen.animation_cancel(restore_frame=False)


def measure(job):
    """Yield while Blender has to go on; write what was found in the end."""
    watch = Watch(Screen(job['screen']))
    prepare(job)
    watch.begin()
    while not watch.finished(FIRST_QUIET):
        yield
    found = []
    yield from play(watch, found) if job['kind'] == 'play' else edits(job, watch, found)
    np.save(os.path.join(job['out'], 'picture.npy'), watch.picture)
    with open(os.path.join(job['out'], 'found.json'), 'w', encoding='utf-8') as file:
        json.dump({'edits': found, 'size': watch.picture.shape[1::-1]}, file)


def main():
    """Measure, then leave Blender."""
    with open(sys.argv[sys.argv.index('--') + 1], encoding='utf-8') as file:
        job = json.load(file)
    engines.register(job['engine'])
    steps = measure(job)

    def tick():
        try:
            next(steps)
            return POLL
        except StopIteration:
            bpy.ops.wm.quit_blender()
        except Exception:  # a timer's exception would leave the window open for ever
            traceback.print_exc()
            os._exit(3)
        return None

    bpy.context.preferences.view.show_splash = False
    bpy.app.timers.register(tick, first_interval=1.0, persistent=True)


main()
