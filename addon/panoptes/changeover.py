# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture that Real-time shows at once, and that changes over to paths of light while the view rests.

A few samples of paths are noise, Real-time is smooth but leaves light out. What is shown lies between
the two, about each pixel nearer to the one whose error is lower there: so nothing jumps, and what
Real-time gets right stays as smooth as it is until paths are better.
"""

import time

from .refinement import Refinement

# Real-time's samples: the least at which edges and soft shadows are smooth.
QUICK_SAMPLES = 4
# Of paths, before they are shown where Combined is not.
PASS_SAMPLES = 8
# Seconds without a new view before paths are traced: what is done once for them, such as gathering
# triangles, would make a turning view stutter.
REST = 0.5


class Changeover:
    """Two refinements of one view; to a 3D View and to `Turns` it is like one `Refinement`."""

    def __init__(self, request, key):
        self.key = key
        self._quick = Refinement(quick(request), key)
        self._paths = Refinement(request, key)
        self._begun = time.monotonic()
        # The error of other passes is not known.
        self._mixes = request.get('shown_pass', 'Combined') == 'Combined'

    @property
    def _now(self):
        return self._paths if self._quick.is_complete() else self._quick

    @property
    def shown(self):
        """What the view shows: float32[H, W, 4], or None."""
        few = not self._mixes and self._paths.samples < min(PASS_SAMPLES, self._paths.wanted)
        return self._quick.shown if few or self._paths.shown is None else self._paths.shown

    @property
    def stage(self):
        """The refinement that is under way, or the last."""
        return self._now

    @property
    def samples(self):
        """How many samples there are, of both."""
        return self._quick.samples + self._paths.samples

    @property
    def wanted(self):
        """How many samples there will be, of both."""
        return self._quick.wanted + self._paths.wanted

    @property
    def warnings(self):
        """What both had to say."""
        return tuple(dict.fromkeys((*self._quick.warnings, *self._paths.warnings)))

    @property
    def first_seconds(self):
        """How long the first sample took, 0 while there is none."""
        return self._quick.first_seconds

    def is_complete(self):
        """Tell whether all samples are there, and the jobs have said all that they have to say."""
        return self._paths.is_complete()

    def is_running(self):
        """Tell whether a job works on it."""
        return self._now.is_running()

    def is_fetched(self):
        """Tell whether nothing of a job is left to fetch."""
        return self._now.is_fetched()

    def is_unread(self):
        """Tell whether the job that works on it may not have read its scene."""
        return self._now.is_unread()

    def is_ready(self):
        """Tell whether the next job may start: at once for Real-time, after a rest for paths."""
        return self._now is self._quick or time.monotonic() - self._begun > REST

    def seconds_running(self):
        """Return for how long the job has been working."""
        return self._now.seconds_running()

    def has_news(self):
        """Tell whether `advance` would change something."""
        return self._now.has_news()

    def start(self, engine):
        """Queue a job for what comes next."""
        if self._now is self._paths:
            self._paths.smooth = self._quick.pixels if self._mixes else None
        self._now.start(engine)

    def advance(self):
        """Fetch the newest samples; let go of a job that has ended. Raises what the job raised."""
        self._now.advance()

    def interrupt(self):
        """Stop the job, keeping what it has made; `start` goes on from there."""
        self._now.interrupt()

    def cancel(self):
        """Stop the job if there is one; may be called from any thread."""
        self._now.cancel()

    def status(self):
        """Return what happens now, in a few words."""
        text = self._now.status()
        return text if self._now is self._quick else f'Paths: {text[:1].lower()}{text[1:]}'


def picture(request, key, passing=False):
    """Return the picture to refine for a request of a 3D View; a `passing` one is soon replaced."""
    staged = request['method'] != 'realtime' and 'debug_picture' not in request['settings']
    if not staged:
        return Refinement(request, key)
    return Refinement(quick(request), key) if passing else Changeover(request, key)


def quick(request):
    """Return the request of the picture that Real-time shows before paths do."""
    first = request['samples'][0]
    return {**request, 'method': 'realtime', 'samples': (first, first + QUICK_SAMPLES)}
