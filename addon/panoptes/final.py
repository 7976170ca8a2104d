# SPDX-License-Identifier: GPL-3.0-or-later
"""Final renders: one view layer of one frame, from sync to the filled passes."""

import time

import bpy

from . import passes, pieces, requests, session
from .results import LayerResult
from .time_left import TimeLeft, clock

# Showing a picture that is still being rendered costs up to a third of a second.
_PREVIEW_INTERVAL = 1.0


def render(engine, depsgraph):
    """Render one view layer for `engine`; raises what the sync and the native module raise."""
    started = time.perf_counter()
    warnings = []

    def warn(sentence):
        if sentence not in warnings:
            warnings.append(sentence)

    layer = depsgraph.view_layer
    request = requests.final(depsgraph, (), warn, part=session.keep_pieces)
    asked = passes.enabled(layer)
    if depsgraph.scene.panoptes.debug_picture == 'none':
        _warn_of_black(asked, request['method'], warn)
    size = (request['width'], request['height'])
    with session.exclusive(wait=True):
        # From here on no 3D View starts another job.
        session.turns.cancel_all()
        _tell(engine, 0.0, 'Synchronising the scene')
        mirror = session.mirror()
        report = session.final_sync.sync(mirror, depsgraph, incremental=False)
        for sentence in report.warnings:
            warn(sentence)

        result = LayerResult(engine, layer.name, size, asked)
        finished = False
        try:
            filled = {entry.name for entry in passes.filled_by(request['method'])}
            names = [name for name in result.pass_names if name in filled]
            request['passes'] = names or ['Combined']
            request['live'] = not bpy.app.background
            request['pieces'] = session.keep_pieces and pieces.can_merge(request, warn)
            job = mirror.engine.render(request)
            cancelled = _follow(engine, job, result, request['settings'])
            # Who cancels keeps what there is.
            finished = not cancelled or job.samples_ready() > 0
            if finished:
                result.fill(job, names, partly=cancelled)
                if request['pieces'] and not cancelled:
                    session.pieces.append((layer.name, pieces.merge_key(depsgraph.scene, request),
                                           job.pieces()))
        finally:
            result.end(cancel=not finished)
        stats = dict(job.stats())

    if cancelled:
        stats['samples'] = job.samples_ready()
    stats['sync_ms'] = report.total_ms
    stats['total_ms'] = (time.perf_counter() - started) * 1e3
    stats['warnings'] = list(dict.fromkeys(warnings + list(stats.get('warnings', ()))))
    for sentence in stats['warnings']:
        engine.report({'WARNING'}, sentence)
    session.add_stats(stats)
    megabytes = stats.get('memory_bytes', 0) / 2**20
    engine.update_memory_stats(memory_used=megabytes, memory_peak=megabytes)


def _warn_of_black(asked, method, warn):
    """Say which passes will stay black because the method does not fill them."""
    filled = passes.filled_by(method)
    black = [entry.name for entry in asked if entry not in filled]
    if black:
        warn(f'Real-time does not fill {", ".join(black)}; choose Primitive Tracing for such passes.')


def _follow(engine, job, result, settings):
    """Wait for a job, telling Blender about it; return whether the artist cancelled it."""
    cancelled = False
    started = shown = time.monotonic()
    time_left = TimeLeft(started)
    while not job.wait(0.05):
        now = time.monotonic()
        left = time_left.seconds(job.progress(), now)
        _tell(engine, job.progress(), job.status() + _remaining(left, now - started, settings))
        if engine.test_break() and not cancelled:
            cancelled = True
            job.cancel()
        if not bpy.app.background and job.samples_ready() and now - shown > _PREVIEW_INTERVAL:
            result.show(job)
            # However long showing took, rendering gets at least as much of the processor.
            shown = time.monotonic()
    job.finish()
    _tell(engine, job.progress(), job.status())
    return cancelled


def _remaining(left, spent, settings):
    """Return the words about the time left (s), or ''; limits of time and noise may shorten it."""
    if left is None:
        return ''
    if 'time_budget' in settings:
        left = min(left, max(settings['time_budget'] - spent, 0.0))
    return f", {'at most ' if 'noise_threshold' in settings else ''}{clock(left)} left"


def _tell(engine, fraction, text):
    engine.update_progress(fraction)
    # Without a window Blender prints a line for each of these.
    if not bpy.app.background:
        engine.update_stats('Panoptes', text)
    if session.progress_listener is not None:
        session.progress_listener(fraction, text)
