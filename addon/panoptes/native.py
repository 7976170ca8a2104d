# SPDX-License-Identifier: GPL-3.0-or-later
"""The native module and the one engine that this process shares.

The engine owns a render thread and a GL context; creating it takes a moment, so it waits for the
first use. It lives until the add-on is disabled or Blender exits.
"""

import atexit
import importlib
import sys
import threading

_lock = threading.Lock()
_engine = None
_factory = None


class Unavailable(RuntimeError):
    """The native module cannot be used; the text is one sentence with cause and remedy."""


def module():
    """Return the module `panoptes_native`; raises `Unavailable`."""
    name = 'panoptes_native'
    if name in sys.modules:
        return sys.modules[name]
    nested = f'{__package__}.{name}'
    version = f'{sys.version_info.major}.{sys.version_info.minor}'
    try:
        try:
            return importlib.import_module(nested)
        except ModuleNotFoundError as error:
            if error.name != nested:
                raise
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        if error.name not in (name, nested):
            raise Unavailable(_broken(error)) from error
        raise Unavailable(
            f'The native part of Panoptes for Python {version} is not installed beside the add-on; '
            'build it with CMake, or install the archive made for this version of Blender.'
        ) from error
    except ImportError as error:
        raise Unavailable(_broken(error)) from error


def _broken(error):
    cause = ' '.join(str(error).split())
    return (f'The native part of Panoptes cannot be loaded ({cause}); install the missing library, '
            'or rebuild Panoptes on this machine.')


def use_factory(factory):
    """Let tests put another engine (a function without arguments) in place of the native one."""
    global _factory
    close()
    _factory = factory


def engine():
    """Return the shared engine, created when first asked for; raises `Unavailable`."""
    global _engine
    with _lock:
        if _engine is None:
            if _factory is not None:
                _engine = _factory()
            else:
                native = module()
                try:
                    _engine = native.Engine()
                except native.Error as error:
                    raise Unavailable(one_line(error)) from error
        return _engine


def close():
    """End the render thread and free the GL context; safe to call at any time, repeatedly."""
    global _engine
    with _lock:
        closing, _engine = _engine, None
    if closing is not None:
        closing.close()


def one_line(error):
    """Return an exception's text on one line."""
    return ' '.join(str(error).split()) or type(error).__name__


atexit.register(close)
