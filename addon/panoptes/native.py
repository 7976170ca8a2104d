# SPDX-License-Identifier: GPL-3.0-or-later
"""The native module and the engines that this process shares, one for each use.

An engine owns a render thread, a GL context and a scene; creating it takes a moment, so it waits for
the first use. It lives until the add-on is disabled or Blender exits.
"""

import atexit
import importlib
import sys
import threading

_lock = threading.Lock()
_engines = {}
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


def engine(use='scene'):
    """Return the engine for 'scene' (final renders and 3D Views) or 'preview' (Blender's icons).

    It is created when first asked for, and anew when the graphics driver has failed; raises
    `Unavailable`.
    """
    with _lock:
        if use in _engines and _engines[use].spoiled:
            _engines.pop(use).close()
        if use not in _engines:
            if _factory is not None:
                _engines[use] = _factory()
            else:
                native = module()
                try:
                    _engines[use] = native.Engine()
                except native.Error as error:
                    raise Unavailable(one_line(error)) from error
        return _engines[use]


def close():
    """End all render threads and free their GL contexts; safe to call at any time, repeatedly."""
    with _lock:
        closing = list(_engines.values())
        _engines.clear()
    for one in closing:
        one.close()


def one_line(error):
    """Return an exception's text on one line."""
    return ' '.join(str(error).split()) or type(error).__name__


atexit.register(close)
