# SPDX-License-Identifier: GPL-3.0-or-later
"""How long a render will still take, from how far it has come."""


class TimeLeft:
    """Told of a render's progress again and again, says when it will be done. Times are in seconds."""

    def __init__(self, started):
        # From here on the pace is measured. The first step includes what is done once, such as compiling.
        self._since, self._base = started, 0.0
        self._changed, self._fraction = started, 0.0
        self._steps = 0

    def seconds(self, fraction, now):
        """Return the time left at `now`, `fraction` (0 to 1) being done; None while nothing is."""
        if fraction > self._fraction:
            if self._steps == 1:
                self._since, self._base = self._changed, self._fraction
            self._changed, self._fraction = now, fraction
            self._steps += 1
        if not self._steps:
            return None
        pace = (self._changed - self._since) / (self._fraction - self._base)
        return max((1.0 - self._fraction) * pace - (now - self._changed), 0.0)


def clock(seconds):
    """Return a time as hours, minutes and seconds: 1:02:03, or 2:03 below an hour."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f'{hours}:{minutes:02}:{rest:02}' if hours else f'{minutes}:{rest:02}'
