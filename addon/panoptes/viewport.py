# SPDX-License-Identifier: GPL-3.0-or-later
"""The 3D View in Rendered shading: one `Viewport` per engine object.

Edits are synchronised in `update`; `draw` starts a job whenever the view or the scene has changed,
draws the newest complete picture, and asks for a redraw when there is a newer one. A job that has
not shown anything yet is left to finish its first sample for a while, so that something appears
while the view turns.
"""

import time

import bpy

from . import compat, requests, session
from .sync import SceneSync

# Seconds that `draw` waits for the first sample of a new view.
_FIRST_SAMPLE_WAIT = 0.25
# Seconds for which an outdated job may go on when it has not shown anything yet.
_GRACE = 1.0
_POLL_INTERVAL = 0.03

# Viewports of the same view layer see the same edits, so they share what is known of the scene.
_syncs = {}


def _sync_for(depsgraph):
    key = (compat.stable_key(depsgraph.scene), depsgraph.view_layer.name)
    return _syncs.setdefault(key, SceneSync())


class Viewport:
    """The running job and the last picture of one 3D View."""

    def __init__(self):
        self._synced = False
        self._changed = True
        self._key = None
        self._job = None
        self._job_started = 0.0
        # Samples in the picture that was fetched last.
        self._shown = 0
        self._samples = 1
        self._pixels = None
        self._failure = ''
        self._warnings = ()
        # Whether a timer waits for news.
        self.polling = False

    def update(self, context, depsgraph):
        """Bring the native scene up to date; called after every edit."""
        with session.exclusive(wait=False) as held:
            if not held:
                # A final render has the engine; all is read again afterwards.
                self._synced = False
                return
            # A running job has its own copy of the scene; `draw` decides when it is outdated.
            self._failure = ''
            try:
                self._sync(context, depsgraph)
            except Exception as error:  # whatever it was, Blender must go on
                self._failure = session.sentence(error)

    def _sync(self, context, depsgraph):
        space = context.space_data
        local = space if space is not None and space.type == 'VIEW_3D' else None
        incremental, self._synced = self._synced, False
        report = _sync_for(depsgraph).sync(session.mirror(), depsgraph, local, incremental)
        self._synced, self._changed = True, True
        self._warnings = tuple(report.warnings)

    def draw(self, engine, context, depsgraph):
        """Draw the newest picture of the current view and keep rendering."""
        with session.exclusive(wait=False) as held:
            if not held:
                engine.update_stats('Panoptes', 'Waiting for the final render to finish')
                self._draw_last(context)
                _redraw_later(engine, self, 0.5)
                return
            try:
                self._draw(engine, context, depsgraph)
            except Exception as error:  # whatever it was, Blender must go on
                self._cancel()
                self._failure = session.sentence(error)
        if self._failure:
            engine.update_stats('Panoptes', self._failure)
            self._draw_last(context)

    def _draw(self, engine, context, depsgraph):
        if self._failure and not self._view_changed(engine, context, depsgraph):
            return
        self._failure = ''
        mirror = session.mirror()
        if not self._synced or mirror.owner is not _sync_for(depsgraph):
            self._synced = False
            self._sync(context, depsgraph)
        # A sample of an outdated view is better than the one before it.
        self._advance()
        if self._view_changed(engine, context, depsgraph) or self._changed:
            self._start(engine, context, depsgraph, mirror)
        self._advance()
        self._draw_last(context)
        if self._job is not None or self._changed:
            engine.update_stats('Panoptes', self._status())
            _redraw_later(engine, self, _POLL_INTERVAL)
        else:
            engine.update_stats('Panoptes', self._idle_status())

    def _status(self):
        if self._job is not None and not self._shown:
            return self._job.status()
        return f'Sample {self._shown}/{self._samples}'

    def _idle_status(self):
        return f'{self._samples} samples' if not self._warnings else self._warnings[0]

    # Jobs

    def _view_key(self, engine, context, depsgraph):
        data, scene = context.region_data, depsgraph.scene
        settings = scene.panoptes
        return (self._size(engine, context, scene), tuple(map(tuple, data.view_matrix)),
                tuple(map(tuple, data.window_matrix)), settings.viewport_samples, settings.seed,
                settings.method, settings.bounces, settings.force_all_effects,
                settings.realtime.shadow_resolution, settings.realtime.soft_shadows,
                scene.render.filter_size, scene.render.film_transparent)

    def _view_changed(self, engine, context, depsgraph):
        return self._key != self._view_key(engine, context, depsgraph)

    @staticmethod
    def _size(engine, context, scene):
        pixel = max(engine.get_preview_pixel_size(scene), 1)
        return max(context.region.width // pixel, 1), max(context.region.height // pixel, 1)

    def _start(self, engine, context, depsgraph, mirror):
        if self._job is not None and not self._job.samples_ready():
            if time.monotonic() - self._job_started < _GRACE:
                return
        self._cancel()
        warnings = []
        scene = depsgraph.scene
        request = requests.viewport(scene, self._size(engine, context, scene), context.region_data,
                                    warnings.append)
        self._key = self._view_key(engine, context, depsgraph)
        self._samples = max(scene.panoptes.viewport_samples, 1)
        self._job = mirror.engine.render(request)
        session.note_preview(self, self._job)
        self._job_started = time.monotonic()
        self._changed, self._shown = False, 0
        self._warnings = tuple(dict.fromkeys((*self._warnings, *warnings)))
        while not self._job.samples_ready() and not self._job.wait(0.005):
            if time.monotonic() - self._job_started > _FIRST_SAMPLE_WAIT:
                break

    def samples_done(self):
        """Return how many complete samples the running job has; 0 without a job."""
        return self._job.samples_ready() if self._job is not None else 0

    def is_rendering(self):
        """Tell whether there is a job."""
        return self._job is not None

    def has_news(self):
        """Tell whether a redraw would show something new."""
        if self._job is None:
            return False
        return self._job.wait(0.0) or self.samples_done() > self._shown

    def _advance(self):
        """Fetch the newest picture; let go of the job when it is done."""
        if self._job is None:
            return
        done = self._job.wait(0.0)
        if done:
            job = self._forget_job()
            job.finish()
            if job.cancelled():
                # A final render needed the engine.
                self._changed = True
            else:
                self._pixels = job.read('Combined')
        elif self.samples_done() > self._shown:
            self._shown = self.samples_done()
            self._pixels = self._job.read('Combined')

    def _forget_job(self):
        job, self._job = self._job, None
        session.note_preview(self, None)
        return job

    def _cancel(self):
        job = self._forget_job()
        if job is not None:
            job.cancel()

    def _draw_last(self, context):
        if self._pixels is not None:
            compat.draw_pixels(self._pixels, context.region.width, context.region.height)

    def close(self):
        """Stop the running job."""
        self._cancel()


def _redraw_later(engine, viewport, interval):
    """Ask for a redraw as soon as there is something new to show.

    Redrawing all the time would take the processor from the job: on a machine without a GPU one
    redraw of Blender's takes longer than a sample.
    """
    if viewport.polling:
        return
    viewport.polling = True

    def poll():
        try:
            # Any access tells whether Blender has freed the engine: the 3D View was closed, or its
            # shading changed.
            _ = engine.is_preview
            if viewport.is_rendering() and not viewport.has_news():
                return interval
            viewport.polling = False
            engine.tag_redraw()
        except ReferenceError:
            viewport.close()
        return None

    bpy.app.timers.register(poll, first_interval=interval)
