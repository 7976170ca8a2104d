# SPDX-License-Identifier: GPL-3.0-or-later
"""Output files: refused before any work, and never left half written."""

import contextlib
import json
import os

from .failure import Failure


def check_output(path, suffixes=None):
    """Return the absolute path of an output file; raises `Failure` if it cannot be written."""
    suffix = os.path.splitext(path)[1].lower()
    if suffixes and suffix not in suffixes:
        raise Failure(f"'{path}' has no format that is known; end it in {' or '.join(suffixes)}.")
    path = os.path.abspath(path)
    folder = os.path.dirname(path)
    if not os.path.isdir(folder):
        raise Failure(f"There is no folder '{folder}'; make it first.")
    if os.path.isdir(path):
        raise Failure(f"'{path}' is a folder; give the name of a file.")
    if not os.access(folder, os.W_OK | os.X_OK):
        raise Failure(f"The folder '{folder}' cannot be written; choose another or change its "
                      'permissions.')
    return path


@contextlib.contextmanager
def replacing(path):
    """Give the name of a temporary file that becomes `path` if all goes well, else vanishes."""
    folder, name = os.path.split(path)
    stem, suffix = os.path.splitext(name)
    temporary = os.path.join(folder, f'.{stem}.{os.getpid()}.part{suffix}')
    try:
        yield temporary
        if not os.path.isfile(temporary):
            raise Failure(f"'{path}' was not written; check the free space in '{folder}'.")
        os.replace(temporary, path)
    except OSError as error:
        raise Failure(f"'{path}' cannot be written ({error.strerror}); check the free space and the "
                      'permissions of its folder.') from None
    finally:
        with contextlib.suppress(OSError):
            os.remove(temporary)


def write_json(path, data):
    with replacing(path) as temporary, open(temporary, 'w', encoding='utf-8') as file:
        json.dump(data, file, indent=2)
        file.write('\n')
