# SPDX-License-Identifier: GPL-3.0-or-later
"""Progress, warnings and errors on the stderr that the user sees."""

import os
import shutil
import signal
import threading
import time


class Console:
    """Writes to the file descriptor that the launcher names, by default 2."""

    _INTERVAL = 0.1

    def __init__(self, descriptor=None):
        if descriptor is None:
            text = os.environ.get('PANOPTES_STDERR_FD', '2')
            descriptor = int(text) if text.isdigit() else 2
        self._descriptor = descriptor
        try:
            self._terminal = os.isatty(descriptor)
        except OSError:
            self._terminal = False
        self._bar = False
        self._last = 0.0
        # A reader that has gone away must not end the render: write() reports it instead.
        if hasattr(signal, 'SIGPIPE') and threading.current_thread() is threading.main_thread():
            signal.signal(signal.SIGPIPE, signal.SIG_IGN)

    def _write(self, text):
        data = text.encode('utf-8', 'replace')
        try:
            while data:
                data = data[os.write(self._descriptor, data):]
        except OSError:
            # Nobody reads any more; that is no reason to stop rendering.
            pass

    def progress(self, fraction, text):
        """Show a bar, on terminals only and not too often."""
        now = time.monotonic()
        if not self._terminal or now - self._last < self._INTERVAL:
            return
        self._last = now
        width = 30
        full = int(width * min(max(fraction, 0.0), 1.0))
        line = f'[{"#" * full}{"." * (width - full)}] {fraction * 100:3.0f}%  {text}'
        columns = shutil.get_terminal_size().columns
        self._write('\r\x1b[K' + line[:columns - 1])
        self._bar = True

    def clear(self):
        """Remove the bar."""
        if self._bar:
            self._write('\r\x1b[K')
            self._bar = False

    def text(self, text):
        """Write a text as it is."""
        self.clear()
        self._write(text)

    def warning(self, sentence):
        """Write one line that does not stop anything."""
        self.clear()
        self._write(f'panoptes: warning: {" ".join(str(sentence).split())}\n')

    def error(self, sentence):
        """Write the one line of an error."""
        self.clear()
        self._write(f'panoptes: {" ".join(str(sentence).split())}\n')
