# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender with a window: edits what a 3D View shows, and compares with pictures of a fresh engine.

-- OUT.json edits LIGHT [some]     each edit in turn, or some of them
-- OUT.json walk LIGHT N SEED      N of them by chance, undo and redo among them; compared every ten

LIGHT is how the 3D View renders: direct (Real-time without the radiance cache), cache (with it), or paths.
"""

import os
import random
import sys
import time

import bpy
import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

# First, since it tells where the add-on is.
from window_steps import area, run  # noqa: E402

import edit_scene  # noqa: E402
import edits  # noqa: E402
import fresh  # noqa: E402
from edit_list import ACTIONS, APART, SOME, WALKED  # noqa: E402

import panoptes  # noqa: E402
from panoptes import native  # noqa: E402

# Seconds in which Blender has noticed any edit: what differs from a fresh picture later is stale.
NOTICED = 3.0
# What Blender's undo does not know.
_UNRECORDED = {edits.undo, edits.redo, edits.orbit, edits.zoom, edits.solid, edits.rendered, edits.play_armature,
               edits.play_shape_keys, edits.split_view, edits.local_view, edits.edit_vertices}


class Walk:
    """What all steps of a run share."""

    def __init__(self, light, seed):
        self.light = light
        self.random = random.Random(seed)
        self.jobs = []
        self.since = 0.0
        self.before = {}
        self.cost = None
        self.shown = []
        fresh.note_jobs(self.jobs)

    def start(self):
        """A small 3D View alone in the window, and as few samples as its light allows."""
        panoptes.register()
        scene = bpy.context.scene
        scene.render.engine = 'PANOPTES'
        scene.render.resolution_x, scene.render.resolution_y = 64, 48
        edit_scene.build()
        scene.render.preview_pixel_size = str(fresh.PIXEL)
        settings = scene.panoptes
        paths = self.light == 'paths'
        settings.method, settings.viewport_samples = ('primitive', 16) if paths else ('realtime', 2)
        settings.realtime.shadow_resolution = 128
        settings.radiance_cache.enabled = self.light == 'cache'
        settings.denoise.viewport = False
        space = area('VIEW_3D').spaces[0]
        space.overlay.show_overlays = space.show_gizmo = False
        space.region_3d.view_perspective = 'PERSP'
        space.region_3d.view_location, space.region_3d.view_distance = (0.0, 0.0, 0.5), 8.0
        space.shading.type = 'RENDERED'
        self.remember('start')
        self._note()

    def close_area(self):
        """Close one of the areas beside the 3D View, of which Blender wants to redraw its window before the next."""
        window = bpy.context.window_manager.windows[0]
        other = next(a for a in window.screen.areas if a.type != 'VIEW_3D')
        with bpy.context.temp_override(window=window, area=other):
            bpy.ops.screen.area_close()

    def alone(self):
        """Tell whether there is one area less than before."""
        return len(bpy.context.window_manager.windows[0].screen.areas)

    def _note(self):
        self.since, self.before, self.cost = time.monotonic(), native.engine().counters(), None
        self.jobs.clear()

    def edit(self, *names):
        """Make edits, after which Blender's undo knows them."""
        self._note()
        # The last of these lines tells what a crash was about.
        print('edit', *names, flush=True)
        changes = [getattr(edits, name) for name in names]
        for change in changes:
            change(self.random)
        if not _UNRECORDED & set(changes):
            self.remember(' '.join(names))

    @staticmethod
    def remember(message):
        """Let Blender's undo know what was edited."""
        with edits.in_view():
            bpy.ops.ed.undo_push(message=message)

    def complete(self):
        """Return [(space, request, viewport)] of all rendered 3D Views; None while one of them is not done."""
        found = []
        for space, region in fresh.rendered_spaces():
            request = fresh.request_of(space, region)
            found.append((space, request, fresh.shown(request)))
        return None if any(view is None for _, _, view in found) else found

    def compared(self):
        """Return the views' differences from fresh pictures and what the edit has cost; None while they are not done."""
        found = self.complete()
        if found is None:
            return None
        if self.cost is None:
            now = native.engine().counters()
            self.cost = {name: now[name] - self.before[name] for name in ('uploaded_bytes', 'programs')}
            self.cost['samples'] = sum(job.samples for job in self.jobs)
            self.cost['seconds'] = time.monotonic() - self.since
        after = native.engine().counters()
        views = [fresh.difference(fresh.pixels_of(view), request, space) for space, request, view in found]
        wrong = any(view['differing'] if self.light == 'direct' else view['apart'] > APART[self.light] for view in views)
        if wrong and time.monotonic() - self.since < NOTICED:
            # The edit goes on, and only the fresh engines' share is no cost of it.
            self.before = {name: self.before[name] + native.engine().counters()[name] - after[name] for name in after}
            self.cost = None
            return None
        shown, self.shown = self.shown, [fresh.pixels_of(view) for _, _, view in found]
        alike = len(shown) == len(self.shown) and all(a.shape == b.shape for a, b in zip(shown, self.shown))
        changed = not alike or not all(map(np.array_equal, shown, self.shown))
        moved = max(map(fresh.apart, shown, self.shown), default=0.0) if alike else None
        return {**self.cost, 'views': views, 'changed': changed, 'moved': moved, 'resident': resident(), 'at': time.monotonic()}

    def completed(self):
        """Return the time as soon as the views are complete."""
        return None if self.complete() is None else {'seconds': time.monotonic() - self.since, 'resident': resident()}

    def played(self):
        """Return the frame as soon as playback has shown a few."""
        scene = bpy.context.scene
        return scene.frame_current if scene.frame_current > scene.frame_start + 3 else None


def resident():
    """Return how many bytes of this process are in memory."""
    with open('/proc/self/statm', encoding='ascii') as file:
        return int(file.read().split()[1]) * os.sysconf('SC_PAGE_SIZE')


def started(walk):
    """Return the steps to a small 3D View alone in the window."""
    return [*((f'close {n}', walk.close_area, walk.alone) for n in range(3)), ('start', walk.start, walk.compared)]


def in_turn(walk, edits):
    """Return the steps of edits in turn; names are numbered, since some edits are made twice."""
    def step(number, name):
        result = walk.played if name.startswith('play') else walk.compared
        return f'{number:02} {name}', lambda: walk.edit(name), result
    return [*started(walk), *(step(n, name) for n, name in enumerate(edits))]


def by_chance(walk, count):
    """Return `count` steps by chance."""
    def step(number):
        def act():
            chosen = walk.random.choice(WALKED)
            walk.edit(*chosen.split())
        return str(number), act, walk.compared if number % 10 == 9 else walk.completed
    return [*started(walk), *(step(number) for number in range(count))]


def main():
    """Do what the command line asks for."""
    kind, light, *more = sys.argv[sys.argv.index('--') + 2:]
    walk = Walk(light, int(more[1]) if kind == 'walk' else 7)
    steps = by_chance(walk, int(more[0])) if kind == 'walk' else in_turn(walk, SOME if more else ACTIONS)
    run(steps, notice=0.1, poll=0.05)


main()
