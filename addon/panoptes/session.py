# SPDX-License-Identifier: GPL-3.0-or-later
"""What outlives Blender's engine objects: the mirror of the native scene, the last render's outcome.

Blender makes and frees `RenderEngine` objects as it likes; everything that has to last between two
frames, or that a script wants to read afterwards, is here.
"""

import contextlib
import json
import sys
import threading
import traceback
import weakref

from . import native
from .refinement import Turns
from .sync import Mirror, SceneSync

# Held by whoever writes to the native scene or renders from it.
_lock = threading.RLock()
_mirror = None

# The jobs of all 3D Views, and the objects behind the views.
turns = Turns()
viewports = weakref.WeakSet()

# Final renders share one, so that the frames of an animation send only what differs.
final_sync = SceneSync()

# Statistics of the last final render (a dictionary by the contract in README), or None.
last_stats = None
# The sentence with which the last final render failed, or ''.
last_error = ''
# Whether final renders keep what merges with other ranges of samples, and what the last one kept:
# (view layer, settings, native pieces) of each layer.
keep_pieces = False
pieces = []
# Called with (fraction 0..1, text) while a final render runs; None when nobody listens.
progress_listener = None


def mirror():
    """Return the mirror of the shared native engine; raises `native.Unavailable`."""
    global _mirror
    engine = native.engine()
    if _mirror is None or _mirror.engine is not engine:
        _mirror = Mirror(engine)
    return _mirror


@contextlib.contextmanager
def exclusive(wait):
    """Give the native scene to the caller; yields False at once if it is taken and not `wait`."""
    held = _lock.acquire(blocking=wait)
    try:
        yield held
    finally:
        if held:
            _lock.release()


def viewport_warnings():
    """Return what the 3D Views have to tell the artist, each sentence once."""
    return list(dict.fromkeys(text for view in list(viewports) for text in view.warnings()))


def sentence(error):
    """Return the one sentence that tells an artist about an exception.

    What was foreseen speaks for itself. The rest is a defect: its traceback goes to the console.
    """
    module = sys.modules.get('panoptes_native') or sys.modules.get(f'{__package__}.panoptes_native')
    known = (native.Unavailable,) + ((module.Error,) if module is not None else ())
    if isinstance(error, known):
        text = native.one_line(error)
        # The native side words its errors as the rest of a line that begins with a name.
        return text[:1].upper() + text[1:] + ('' if text.endswith(('.', '!', '?')) else '.')
    traceback.print_exception(type(error), error, error.__traceback__)
    return (f'Panoptes stopped on an unexpected error ({type(error).__name__}: '
            f'{native.one_line(error)}); please report it with the console output.')


def start_final():
    """Forget the outcome of the last final render."""
    global last_stats, last_error, pieces
    last_stats, last_error, pieces = None, '', []


def fail_final(text):
    """Note that the final render failed."""
    global last_error
    last_error = text


def add_stats(stats):
    """Note one view layer's statistics; those of several layers are added up."""
    global last_stats
    if last_stats is None:
        last_stats = stats
        return
    total = last_stats
    for name in ('sync_ms', 'build_ms', 'trace_ms', 'total_ms', 'rays'):
        total[name] = total.get(name, 0) + stats.get(name, 0)
    total['memory_bytes'] = max(total.get('memory_bytes', 0), stats.get('memory_bytes', 0))
    total['warnings'] = list(dict.fromkeys(total['warnings'] + stats['warnings']))
    for name in ('passes', 'effects'):
        by_name = {entry['name']: entry for entry in total.get(name, ())}
        for entry in stats.get(name, ()):
            known = by_name.get(entry['name'])
            if known is None:
                total.setdefault(name, []).append(entry)
                continue
            known['ms'] = known.get('ms', 0) + entry.get('ms', 0)
            if entry.get('runs') and not known.get('runs'):
                known.update(runs=True, reason=entry['reason'])


def stats_text():
    """Return the last statistics as JSON, or ''."""
    return json.dumps(last_stats) if last_stats is not None else ''
