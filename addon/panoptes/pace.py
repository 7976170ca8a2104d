# SPDX-License-Identifier: GPL-3.0-or-later
"""How coarse a 3D View's picture may be while the view or the scene moves, so that it keeps up.

A single edit is answered at full resolution. Where the next one follows before the view has come to
rest, pictures get coarser until each fits its budget; at rest the full resolution comes back.
"""

import math
import time

# Seconds without a change after which a view rests.
REST = 0.4
# One pixel of the picture covers at most so many by so many of the region.
COARSEST = 4


class Pace:
    """Told of changes and of how long pictures took; says how coarse the next one is."""

    def __init__(self):
        self._changed = -math.inf
        # Seconds that a picture of full resolution takes to its first sample, as far as is known.
        self._full = 0.0
        self.coarseness = 1

    def changed(self, budget, now=None):
        """Note that the picture is another from now on; `budget` is in seconds, 0 for none."""
        now = time.monotonic() if now is None else now
        moving, self._changed = now - self._changed < REST, now
        self.coarseness = 1
        if moving and budget > 0.0 and self._full > budget:
            # A picture's time is about proportional to its pixels.
            self.coarseness = min(math.ceil(math.sqrt(self._full / budget)), COARSEST)

    def took(self, seconds, coarseness):
        """Note how long a picture that was so coarse took to its first sample."""
        full = seconds * coarseness ** 2
        # What is done whatever the size is overrated by a coarse picture.
        self._full = full if coarseness == 1 else min(full, self._full)

    def rests(self, now=None):
        """Tell whether nothing has changed for a while."""
        now = time.monotonic() if now is None else now
        return now - self._changed >= REST

    def refine(self):
        """Return whether the picture is coarse and the view rests: then it is full from now on."""
        if self.coarseness == 1 or not self.rests():
            return False
        self.coarseness = 1
        return True
