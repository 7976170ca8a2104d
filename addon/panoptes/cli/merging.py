# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures in pieces: ranges of samples that are rendered apart and put together."""

import json
import os

from .. import native, session
from .failure import Failure
from .files import check_output, replacing


def add_pieces(path, console):
    """Put the pieces that the last render kept behind the picture at `path`, which stays as it is.

    Where that does not work, the picture alone is left, with a warning.
    """
    if not session.pieces:
        return
    try:
        with replacing(path) as temporary:
            native.module().add_pieces(path, temporary, session.pieces)
    except native.module().Error as error:
        console.warning(f'The picture cannot be merged with others ({native.one_line(error)}).')
    finally:
        session.pieces = []


def merge(options, console):
    """Write the picture of all samples of several files, with its pieces."""
    path = check_output(options.output, ('.exr',))
    files = [_File(name) for name in options.files]
    files.sort(key=lambda file: file.layers[0][2])
    for file in files[1:]:
        _check_settings(files[0], file)
    for before, after in zip(files, files[1:]):
        _check_ranges(before, after)
    try:
        with replacing(path) as temporary:
            left_out = native.module().merge_pieces([file.name for file in files], temporary)
    except native.module().Error as error:
        raise Failure(session.sentence(error)) from None
    if left_out:
        others = f' and {len(left_out) - 1} more' if len(left_out) > 1 else ''
        console.warning(f"Channel '{left_out[0]}'{others} of '{files[0].name}' was not rendered by "
                        'Panoptes; it is left out.')


class _File:
    """What a file holds: `layers` are (name, settings as JSON, first sample, last sample)."""

    def __init__(self, name):
        self.name = name
        if not os.path.isfile(name):
            raise Failure(f"There is no file '{name}'; check the path.")
        try:
            self.layers = sorted(native.module().find_pieces(name))
        except native.module().Error as error:
            raise Failure(session.sentence(error)) from None
        if not self.layers:
            raise Failure(f"'{name}' holds no pieces of a picture; render it to .exr with a range of "
                          'samples, such as --samples 0:16, and without a noise threshold.')


def _check_settings(one, other):
    """Refuse two files that are not parts of one picture."""
    if [layer[0] for layer in one.layers] != [layer[0] for layer in other.layers]:
        raise Failure(f"'{other.name}' has other view layers than '{one.name}'; render both with the same "
                      'ones.')
    for (_, ours, *_), (_, theirs, *_) in zip(one.layers, other.layers):
        ours, theirs = json.loads(ours), json.loads(theirs)
        different = sorted(key for key in ours.keys() | theirs.keys()
                           if ours.get(key) != theirs.get(key))
        if different:
            raise Failure(f"'{other.name}' was rendered with another {', '.join(different)} than "
                          f"'{one.name}'; render both with the same settings.")


def _check_ranges(before, after):
    """Refuse files between whose samples there is a gap or an overlap."""
    for (*_, first, last), (*_, next_first, next_last) in zip(before.layers, after.layers):
        if next_first < last:
            raise Failure(f"Samples {next_first}:{min(last, next_last)} are in '{before.name}' as well as in "
                          f"'{after.name}'; leave one of the files out.")
        if next_first > last:
            raise Failure(f"Samples {last}:{next_first} are missing between '{before.name}' ({first}:{last}) "
                          f"and '{after.name}' ({next_first}:{next_last}); render them with --samples "
                          f'{last}:{next_first}.')
