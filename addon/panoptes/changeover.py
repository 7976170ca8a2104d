# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture that Real-time shows at once, and that changes over to paths of light while the view rests.

A few samples of paths are noise, Real-time is smooth but leaves light out. What is shown is a mean of
the two whose weight for paths grows with their samples: first nothing, then more and more, and in the
end it is all of it. So nothing jumps, and the finished picture is that of paths alone.
"""

import time

from .refinement import Refinement

# Real-time's samples: the least at which edges and soft shadows are smooth.
QUICK_SAMPLES = 4
# Paths do not show before the first of these numbers of samples, and nothing else from the second on.
# On the way their noise falls from about what Real-time leaves out to a third of it (RMSE of Cycles on
# Sponza: .09 at 4 samples, .039 at 16).
HIDDEN_SAMPLES, SHOWN_SAMPLES = 3, 16
# Seconds without a new view before paths are traced: what is done once for them, such as gathering
# triangles, would make a turning view stutter.
REST = 0.5


def weight(samples, wanted):
    """Return the share (0 to 1) that paths have in the picture after so many samples of `wanted`."""
    if samples >= wanted:
        return 1.0
    return min(max((samples - HIDDEN_SAMPLES) / (SHOWN_SAMPLES - HIDDEN_SAMPLES), 0.0), 1.0)


class Changeover:
    """Two refinements of one view; to a 3D View and to `Turns` it is like one `Refinement`."""

    def __init__(self, request, key):
        self.key = key
        self.pixels = None
        self._quick = Refinement(quick(request), key)
        self._paths = Refinement(request, key)
        self._begun = time.monotonic()

    @property
    def _now(self):
        return self._paths if self._quick.is_complete() else self._quick

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
        self._now.start(engine)

    def advance(self):
        """Fetch the newest samples; let go of a job that has ended. Raises what the job raised."""
        self._after(self._now.advance)

    def interrupt(self):
        """Stop the job, keeping what it has made; `start` goes on from there."""
        self._after(self._now.interrupt)

    def _after(self, change):
        before = self.samples
        change()
        if self.samples != before or self.pixels is None:
            self._mix()

    def _mix(self):
        share = weight(self._paths.samples, self._paths.wanted)
        if share <= 0.0:
            self.pixels = self._quick.pixels
        elif share >= 1.0:
            self.pixels = self._paths.pixels
        else:
            self.pixels = self._quick.pixels * (1.0 - share) + self._paths.pixels * share

    def cancel(self):
        """Stop the job if there is one; may be called from any thread."""
        self._now.cancel()

    def status(self):
        """Return what happens now, in a few words."""
        text = self._now.status()
        return text if self._now is self._quick else f'Paths: {text[:1].lower()}{text[1:]}'


def picture(request, key, passing=False):
    """Return the picture to refine for a request of a 3D View; a `passing` one is soon replaced."""
    staged = request['method'] == 'primitive' and 'debug_picture' not in request['settings']
    if not staged:
        return Refinement(request, key)
    return Refinement(quick(request), key) if passing else Changeover(request, key)


def quick(request):
    """Return the request of the picture that Real-time shows before paths do."""
    first = request['samples'][0]
    return {**request, 'method': 'realtime', 'samples': (first, first + QUICK_SAMPLES)}
