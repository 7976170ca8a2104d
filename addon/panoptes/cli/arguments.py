# SPDX-License-Identifier: GPL-3.0-or-later
"""Parsing the command line; every mistake is one line."""

import argparse
import re
from typing import NamedTuple

from .console import Console
from .failure import BadCommandLine

METHODS = ('auto', 'realtime', 'fragment', 'primitive')


class _Parser(argparse.ArgumentParser):
    """argparse without its usage dump, and with its help where the user sees it."""

    def _print_message(self, message, file=None):
        Console().text(message)

    def error(self, message):
        raise BadCommandLine(f'{message}; {self.prog} --help lists the options.')


class Samples(NamedTuple):
    """Samples `first` up to `last`; `is_range` where both ends were named."""

    first: int
    last: int
    is_range: bool


def _samples(text):
    match = re.fullmatch(r'(?:(\d+):)?(\d+)', text)
    if match is None:
        raise argparse.ArgumentTypeError(f"'{text}' is neither a count (16) nor a range (0:16)")
    first, last = int(match[1] or 0), int(match[2])
    if last <= first:
        raise argparse.ArgumentTypeError(f"'{text}' holds no sample")
    return Samples(first, last, match[1] is not None)


def _size(text):
    match = re.fullmatch(r'(\d+)[xX](\d+)', text)
    if match is None:
        raise argparse.ArgumentTypeError(f"'{text}' is not of the form WIDTHxHEIGHT")
    width, height = int(match[1]), int(match[2])
    if width < 1 or height < 1:
        raise argparse.ArgumentTypeError(f"'{text}' has no pixels; give at least 1x1")
    if max(width, height) > 65536:
        raise argparse.ArgumentTypeError(f"'{text}' is more than Blender can hold (65536x65536)")
    return width, height


def _count(text):
    if not re.fullmatch(r'\d+', text):
        raise argparse.ArgumentTypeError(f"'{text}' is not a whole number of 0 or more")
    return int(text)


def _positive(text):
    try:
        number = float(text)
    except ValueError:
        number = -1.0
    if not 0.0 <= number < float('inf'):
        raise argparse.ArgumentTypeError(f"'{text}' is not a number of 0 or more")
    return number


def _frame(text):
    try:
        return int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' is not a whole number") from None


def _assignment(text):
    key, separator, value = text.partition('=')
    if not separator or not key:
        raise argparse.ArgumentTypeError(f"'{text}' is not of the form KEY=VALUE")
    return key.strip(), value.strip()


def _add_scene_options(parser):
    parser.add_argument('file', metavar='FILE.blend')
    parser.add_argument('--method', choices=METHODS, help='how light is computed')
    parser.add_argument('--samples', type=_samples, metavar='N|A:B',
                        help='samples a pixel, or the range from A up to B, whose .exr can be merged '
                             'with others')
    parser.add_argument('--bounces', type=_count, metavar='N',
                        help='reflections of indirect light, by any method')
    parser.add_argument('--size', type=_size, metavar='WxH', help='pixels')
    parser.add_argument('--frame', type=_frame, metavar='N')
    parser.add_argument('--seed', type=_count, metavar='N')
    parser.add_argument('--time-budget', type=_positive, metavar='S',
                        help='stop after the sample that exceeds S seconds')
    parser.add_argument('--noise-threshold', type=_positive, metavar='X',
                        help='stop when the estimated relative error is below X')
    parser.add_argument('--force-all-effects', action='store_true',
                        help='run effects that the scene cannot show, too')
    parser.add_argument('--set', type=_assignment, action='append', default=[], metavar='KEY=VALUE',
                        dest='assignments', help='any option of scene.panoptes, e.g. '
                                                 'realtime.shadow_resolution=1024')


def _parser():
    parser = _Parser(prog='panoptes', allow_abbrev=False)
    commands = parser.add_subparsers(dest='command', required=True, parser_class=_Parser)
    render = commands.add_parser('render', help='render a picture', allow_abbrev=False)
    _add_scene_options(render)
    render.add_argument('-o', '--output', required=True, metavar='OUT.(png|exr)')
    render.add_argument('--stats', metavar='OUT.json', help='write statistics')
    merge = commands.add_parser(
        'merge', help='put ranges of samples together', allow_abbrev=False,
        description='Writes the picture of all samples of .exr files that were rendered with --samples '
                    'A:B, with the same bits as if they had been rendered at once. The ranges must follow '
                    'on each other, whatever the order of the files; size, passes, seed and settings must '
                    'agree. Whether the scene is the same nobody checks.')
    merge.add_argument('output', metavar='OUT.exr')
    merge.add_argument('files', metavar='IN.exr', nargs='+')
    snapshot = commands.add_parser('snapshot', help='write a scene for the driver',
                                   allow_abbrev=False)
    _add_scene_options(snapshot)
    snapshot.add_argument('-o', '--output', required=True, metavar='FILE.scene')
    viewport = commands.add_parser('viewport', help='open Blender with the engine chosen',
                                   allow_abbrev=False)
    viewport.add_argument('file', metavar='FILE.blend')
    return parser


def parse(words):
    """Return the options of a command line; raises `BadCommandLine` with one line on a mistake."""
    return _parser().parse_args(words)
