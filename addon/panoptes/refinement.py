# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture that gains samples, and can be interrupted and go on where it was.

The native engine renders one job at a time, but there may be several 3D Views. Each has a
`Refinement`; `Turns` says whose job runs: a view that has nothing to show yet goes before views that
only become smoother, and those go on one after the other.
"""

import threading
import time


class Refinement:
    """The picture of one request.

    `pixels` is float32[H, W, 4] as soon as `samples` is not 0; before, it may be a first look without
    some effects. `shown` is what a 3D View shows: the same, or, where it takes over the picture
    `smooth`, that of the two whose error is lower, or what lies between them. `first_seconds` is how
    long the first sample took, 0 while there is none.
    """

    def __init__(self, request, key):
        self.key = key
        self.pixels = self.shown = self.smooth = None
        self.samples = 0
        # What the newest job has told of the samples that are there; {} before.
        self.stats = {}
        self.first_seconds = 0.0
        self._request = request
        self._first, self._last = request['samples']
        # What earlier jobs have made.
        self._base = None
        self._base_samples = 0
        self._job = None
        self._started = 0.0

    @property
    def warnings(self):
        """What the newest job had to say."""
        return tuple(self.stats.get('warnings', ()))

    @property
    def method(self):
        """How it is rendered: 'realtime', 'fragment' or 'primitive'."""
        return self._request['method']

    @property
    def stage(self):
        """The refinement that is under way: this one."""
        return self

    @property
    def wanted(self):
        """How many samples the finished picture has."""
        return self._last - self._first

    def is_complete(self):
        """Tell whether all samples are there, and the job has said all that it has to say."""
        return self._job is None and self.samples >= self.wanted

    def is_running(self):
        """Tell whether a job works on it."""
        return self._job is not None and not self._job.wait(0.0)

    def is_unread(self):
        """Tell whether the job that works on it may not have read its scene: it has no sample yet."""
        return self.is_running() and not self._job.samples_ready()

    def is_ready(self):
        """Tell whether the next job may start."""
        return True

    def seconds_running(self):
        """Return for how long the job has been working."""
        return time.monotonic() - self._started

    def is_fetched(self):
        """Tell whether nothing of a job is left to fetch. It may end between two questions about it."""
        return self._job is None

    def has_news(self):
        """Tell whether `advance` would change something."""
        if self._job is None:
            return False
        return (self._job.wait(0.0) or self._base_samples + self._job.samples_ready() > self.samples
                or self.pixels is None and self._job.has_look())

    def start(self, engine):
        """Queue a job for the samples that are missing."""
        self._base, self._base_samples = self.pixels, self.samples
        samples = (self._first + self.samples, self._last)
        request = {**self._request, 'samples': samples}
        if self.smooth is not None:
            request['smooth'] = self.smooth
            if self._base_samples:
                request.update(before=self._base, before_samples=self._base_samples)
        self._job = engine.render(request)
        self._started = time.monotonic()

    def advance(self):
        """Fetch the newest picture; let go of a job that has ended. Raises what the job raised."""
        job = self._job
        if job is None:
            return
        ended = job.wait(0.0)
        if ended:
            self._job = None
            job.finish()
        if ended or self._base_samples + job.samples_ready() > self.samples:
            self._fetch(job)
            self.stats = job.stats()
        elif self.pixels is None and job.has_look():
            self.pixels = self.shown = job.read('Combined')

    def interrupt(self):
        """Stop the job, keeping what it has made; `start` goes on from there."""
        job, self._job = self._job, None
        if job is not None:
            job.cancel()
            self._fetch(job)

    def _fetch(self, job):
        count, before = job.samples_ready(), -1
        if not count:
            return
        # The picture may grow while it is read.
        while count != before:
            before, pixels, count = count, job.read('Combined'), job.samples_ready()
        total = self._base_samples + count
        if self._base_samples:
            pixels = (self._base * self._base_samples + pixels * count) / total
        self.pixels, self.samples = pixels, total
        # A mixture takes two samples at least.
        mixed = pixels if self.smooth is None else job.read_shown()
        if mixed is not None:
            self.shown = mixed
        self.first_seconds = self.first_seconds or job.first_sample_seconds()

    def cancel(self):
        """Stop the job if there is one; may be called from any thread."""
        job = self._job
        if job is not None:
            job.cancel()

    def status(self):
        """Return what happens now, in a few words."""
        if self.is_complete():
            return f'{self.samples} samples'
        if self._job is not None and not self.samples:
            return self._job.status().capitalize()
        return f'Sample {self.samples}/{self.wanted}'


class Turns:
    """Whose job may run. Holds refinements that have been given a turn."""

    def __init__(self):
        self._lock = threading.Lock()
        self._running = []

    def _others(self, refinement):
        with self._lock:
            self._running = [r for r in self._running if r.is_running()]
            return [r for r in self._running if r is not refinement]

    def is_free(self, refinement):
        """Tell whether `take` would succeed."""
        return all(not refinement.samples and other.samples for other in self._others(refinement))

    def take(self, refinement, start):
        """Call `start`, which starts the refinement's job, if it may run; interrupts those that can wait.

        Tells whether it was called.
        """
        if not self.is_free(refinement):
            return False
        for other in self._others(refinement):
            other.interrupt()
        start()
        # Not before: without a job it would count as one that has ended.
        with self._lock:
            self._running = [r for r in self._running if r is not refinement] + [refinement]
        return True

    def interrupt_unread(self):
        """Interrupt jobs that may not have read their scene, which will change."""
        for other in self._others(None):
            if other.is_unread():
                other.interrupt()

    def cancel_all(self):
        """Stop all jobs."""
        for other in self._others(None):
            other.cancel()
