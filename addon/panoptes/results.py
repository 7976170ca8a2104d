# SPDX-License-Identifier: GPL-3.0-or-later
"""From the pictures of a native job to the passes of Blender's render result."""

from . import compat, passes


class LayerResult:
    """The render result of one view layer, begun and ended exactly once."""

    def __init__(self, engine, layer_name, size, asked=()):
        """Begin a result of `size` (width, height); `asked` are the `passes.Pass` that it shall have."""
        self._engine = engine
        for entry in asked:
            if entry.ours:
                engine.add_pass(entry.name, entry.channels, entry.channel_ids, layer=layer_name)
        self._result = engine.begin_result(0, 0, *size, layer=layer_name)
        self.pass_names = [p.name for p in self._passes() if p.name in passes.BY_NAME]

    def _passes(self):
        return self._result.layers[0].passes if self._result.layers else ()

    def fill(self, job, names, partly=False):
        """Copy the job's last complete sample to these passes.

        With `partly`, passes that the job has not come to stay black; otherwise that raises its error.
        """
        for target in self._passes():
            if target.name not in names:
                continue
            try:
                pixels = job.read(target.name)
            except RuntimeError:
                if not partly:
                    raise
                continue
            compat.write_pass(target, pixels)

    def show(self, job):
        """Show the combined picture so far."""
        self.fill(job, ('Combined',))
        self._engine.update_result(self._result)

    def end(self, cancel=False):
        """Hand the result to Blender."""
        self._engine.end_result(self._result, cancel=cancel)
