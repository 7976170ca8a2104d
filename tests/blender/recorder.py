# SPDX-License-Identifier: GPL-3.0-or-later
"""A stand-in for the native engine that writes down what it is told and renders a flat grey."""

import numpy as np


class Recorder:
    """Has the calls of `panoptes_native.Engine`; `calls` lists (name, arguments)."""

    device = 'recorder'
    spoiled = False

    def __init__(self):
        self.calls = []
        self.closed = False
        self.refuse_files = False

    def __getattr__(self, name):
        if not name.startswith(('set_', 'remove_', 'write_')):
            raise AttributeError(name)

        def call(*arguments):
            if self.refuse_files and name in ('set_image_file', 'set_image_encoded'):
                raise RuntimeError('unknown format')
            self.calls.append((name, arguments))

        return call

    def names(self):
        """Return the names of all calls so far."""
        return [name for name, _ in self.calls]

    def arguments(self, name):
        """Return the arguments of every call of this name."""
        return [arguments for called, arguments in self.calls if called == name]

    def clear(self):
        """Forget the calls so far."""
        self.calls = []

    def render(self, request):
        """Return a finished job."""
        self.calls.append(('render', (request,)))
        return Job(request)

    def close(self):
        """Note that the engine was closed."""
        self.closed = True


class Job:
    """A job that is done before it starts."""

    _CHANNELS = {'Combined': 4, 'Depth': 1, 'Debug Sample Count': 1, 'Noisy Image': 4}

    def __init__(self, request):
        self._request = request

    def progress(self):
        """Return 1."""
        return 1.0

    def status(self):
        """Return a text."""
        return 'Finished'

    def wait(self, seconds):
        """Return True."""
        return True

    def cancel(self):
        """Do nothing."""

    def cancelled(self):
        """Return False."""
        return False

    def finish(self):
        """Do nothing."""

    def samples_ready(self):
        """Return how many samples were asked for."""
        first, last = self._request['samples']
        return last - first

    def read(self, name):
        """Return half grey."""
        shape = (self._request['height'], self._request['width'], self._CHANNELS.get(name, 3))
        return np.full(shape, 0.5, np.float32)

    def stats(self):
        """Return statistics as the native engine does."""
        return {'device': 'recorder', 'size': [self._request['width'], self._request['height']],
                'samples': 1, 'effects': [], 'passes': [], 'build_ms': 0.0, 'trace_ms': 0.0,
                'total_ms': 0.0, 'rays': 0, 'cache': {'cells': 0, 'fewer': 0, 'lattice': 0}, 'memory_bytes': 0,
                'estimated_error': 0.0, 'warnings': []}
