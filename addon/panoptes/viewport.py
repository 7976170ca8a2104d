# SPDX-License-Identifier: GPL-3.0-or-later
"""The 3D View in Rendered shading: one `Viewport` per engine object.

Edits are synchronised in `update`; `draw` begins a new picture whenever the view or the scene is
another, draws the newest samples, and asks for a redraw when there are more. A picture that has not
shown anything yet is left to finish its first sample for a while, so that something appears while the
view turns.
"""

import time

import bpy

from . import changeover, compat, requests, session, statistics_text, view_shading
from .pace import Pace
from .sync import SceneSync
from .time_left import TimeLeft

# Seconds for which an outdated job may go on when it has not shown anything yet.
_GRACE = 1.0
_POLL_INTERVAL = 0.01

# Viewports that show the same objects of the same view layer see the same edits, so they share what
# is known of the scene.
_syncs = {}


def _sync_for(depsgraph, space):
    key = (compat.stable_key(depsgraph.scene), depsgraph.view_layer.name,
           space.as_pointer() if space is not None and _has_own_objects(space) else 0)
    return _syncs.setdefault(key, SceneSync())


def _has_own_objects(space):
    return space.local_view is not None or space.use_local_collections


def _space(context):
    space = context.space_data
    return space if space is not None and space.type == 'VIEW_3D' else None


class Viewport:
    """The refining picture of one 3D View, and the last that it has shown."""

    def __init__(self):
        self._synced = False
        # The state of the native scene that this view shows.
        self._state = None
        self._picture = None
        # What the view shows at full resolution, and how much coarser its picture is while it moves.
        self._key = None
        self._pace = Pace()
        # What is shown, and where in the region; and where the picture that is refined belongs.
        self._pixels = None
        self._rectangle = self._rectangle_ahead = (0, 0, 1, 1)
        self._failure = ''
        self._sync_warnings = ()
        self._request_warnings = ()
        # The part of the picture under way, and how long it will take.
        self._stage, self._time_left = None, None
        # What the view shows, by its name in menus; '' for Combined.
        self._label = ''
        # The address of the region that was drawn last, and when.
        self.region, self.drawn = 0, 0.0
        # Whether a timer waits for news.
        self.polling = False
        session.viewports.add(self)

    def update(self, engine, context, depsgraph):
        """Bring the native scene up to date, and begin its picture; called after every edit."""
        with session.exclusive(wait=False) as held:
            if not held:
                # A final render has the engine; all is read again afterwards.
                self._synced = False
                return
            self._failure = ''
            try:
                self._sync(context, depsgraph)
                # The first sample is under way while Blender redraws its window.
                self._refine(engine, context, depsgraph)
            except Exception as error:  # whatever it was, Blender must go on
                self._failure = session.sentence(error)

    def _sync(self, context, depsgraph):
        space, mirror = _space(context), session.mirror()
        sync = _sync_for(depsgraph, space)
        if mirror.owner is not sync:
            session.turns.interrupt_unread()
        incremental, self._synced = self._synced, False
        report = sync.sync(mirror, depsgraph, space, incremental)
        self._synced, self._state = True, mirror.state()
        self._sync_warnings = tuple(report.warnings)

    def draw(self, engine, context, depsgraph):
        """Draw the newest picture of the current view and keep rendering."""
        self.region, self.drawn = context.region.as_pointer(), time.monotonic()
        with session.exclusive(wait=False) as held:
            if not held:
                engine.update_stats('Panoptes', 'Waiting for the final render to finish')
                self._draw_last()
                _redraw_later(engine, self, 0.5)
                return
            try:
                self._refine(engine, context, depsgraph)
                engine.update_stats('Panoptes', self._status())
                if self.is_rendering():
                    _redraw_later(engine, self, _POLL_INTERVAL)
            except Exception as error:  # whatever it was, Blender must go on
                self.close()
                self._failure = session.sentence(error)
        if self._failure:
            engine.update_stats('Panoptes', self._failure)
        self._draw_last()

    def _refine(self, engine, context, depsgraph):
        """Fetch what there is of the newest picture, and keep rendering what the view shows now."""
        warnings, shown = [], view_shading.shown(depsgraph.scene, _space(context))
        request, rectangle = requests.viewport(
            depsgraph, context.region, context.region_data, _space(context),
            max(engine.get_preview_pixel_size(depsgraph.scene), 1), warnings.append, shown)
        if self._failure and self._key == _key(request, self._state):
            return
        self._failure = ''
        self._request_warnings = tuple(warnings)
        self._label = '' if shown is view_shading.COMBINED else shown.label
        if not self._synced:
            self._sync(context, depsgraph)
        # A sample of an outdated view is better than the one before it.
        self._advance()
        self._follow(request, depsgraph.scene.panoptes.viewport_budget)
        if self._picture is None or self._picture.key != (self._key, self._pace.coarseness):
            self._begin(requests.coarser(request, self._pace.coarseness), rectangle)
        if not self._picture.is_complete() and self._picture.is_fetched():
            self._start(context, depsgraph)
        self._advance()

    def _follow(self, request, budget):
        """Note what the view shows now, and choose how coarsely."""
        key = _key(request, self._state)
        if key != self._key:
            self._key = key
            self._pace.changed(budget)
        else:
            self._pace.refine()

    def _begin(self, request, rectangle):
        """Make the request's picture the one to refine, unless the last deserves its first sample."""
        last = self._picture
        if last is not None and last.is_running():
            if not last.samples and last.seconds_running() < _GRACE:
                return
            last.interrupt()
        coarseness = self._pace.coarseness
        self._picture = changeover.picture(request, (self._key, coarseness), passing=coarseness > 1)
        self._rectangle_ahead = rectangle

    def _start(self, context, depsgraph):
        """Start the picture's job if it is this view's turn."""
        def start():
            mirror = session.mirror()
            if mirror.owner is not _sync_for(depsgraph, _space(context)):
                # Another view or a final render has written its own version of the scene.
                self._sync(context, depsgraph)
            self._picture.start(mirror.engine)

        if self._picture.is_ready():
            session.turns.take(self._picture, start)

    def _advance(self):
        """Fetch the newest samples."""
        picture = self._picture
        if picture is None:
            return
        known = picture.first_seconds
        picture.advance()
        if picture.first_seconds and not known:
            self._pace.took(picture.first_seconds, picture.key[1])
        if picture.shown is not None:
            self._pixels, self._rectangle = picture.shown, self._rectangle_ahead

    def _seconds_left(self):
        """Return how long the part of the picture that is under way will still take, or None."""
        stage = self._picture.stage
        if stage is not self._stage:
            self._stage, self._time_left = stage, TimeLeft(time.monotonic())
        if not stage.is_running():
            return None
        return self._time_left.seconds(stage.samples / stage.wanted, time.monotonic())

    def statistics(self, letters):
        """Return lines of text about the picture: how far it is, what takes the time, what is skipped."""
        if self._failure or self._picture is None:
            return [self._failure] if self._failure else []
        stage = self._picture.stage
        return statistics_text.lines(stage.stats, stage.method, stage.samples, stage.wanted,
                                     self._picture.key[1], self._seconds_left(), letters)

    def _status(self):
        picture = self._picture
        text = (f'{self._label}: ' if self._label else '') + picture.status()
        text += statistics_text.left(self._seconds_left())
        if picture.key[1] > 1:
            text += f' at 1/{picture.key[1]} of the resolution'
        if not (picture.is_complete() or picture.is_running()) and picture.is_ready():
            text += ', waiting for another 3D View'
        warnings = self.warnings()
        if not warnings:
            return text
        more = f' ({len(warnings) - 1} more in the Render properties)' if len(warnings) > 1 else ''
        return f'{text} | {warnings[0]}{more}'

    def warnings(self):
        """Return sentences about what this view cannot show."""
        of_job = self._picture.warnings if self._picture is not None else ()
        return list(dict.fromkeys((*self._request_warnings, *self._sync_warnings, *of_job)))

    def is_rendering(self):
        """Tell whether there are samples to come."""
        coming = self._picture is not None and not (self._picture.is_complete() and self._pace.coarseness == 1)
        return coming and not self._failure

    def has_news(self):
        """Tell whether a redraw would show or start something."""
        picture = self._picture
        if self._pace.coarseness > 1 and self._pace.rests():
            return True
        idle = not picture.is_running() and picture.is_ready() and not picture.is_complete()
        return picture.has_news() or idle and session.turns.is_free(picture)

    def _draw_last(self):
        if self._pixels is not None:
            compat.draw_pixels(self._pixels, *self._rectangle)

    def close(self):
        """Stop the running job."""
        if self._picture is not None:
            self._picture.interrupt()


def _key(request, state):
    """Return what tells pictures apart: the request's values and the state of the scene."""
    return (state, tuple((name, value.tobytes() if hasattr(value, 'tobytes') else repr(value))
                         for name, value in request.items()))


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
