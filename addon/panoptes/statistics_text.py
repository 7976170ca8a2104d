# SPDX-License-Identifier: GPL-3.0-or-later
"""A 3D View's statistics in words: from the native engine's dictionaries to lines of text."""

from .time_left import clock

METHODS = {'realtime': 'Real-time', 'fragment': 'Fragments', 'primitive': 'Paths'}

# So many effects are named with their time.
_MOST_TIMED = 4
_MOST_OF_A_REASON = 3
_MORE = ' and {} more'
# Of what is skipped, an artist looks for these first.
_MAIN = ('radiance_cache', 'ambient_occlusion', 'specular_rays', 'indirect_light', 'world_light',
         'direct_light', 'emissive_light', 'depth_of_field')


def lines(stats, method, samples, wanted, coarseness=1, seconds_left=None, letters=150):
    """Return the lines of text about a picture.

    `stats` is that of its job, {} while there is none; `method` one of METHODS; one pixel of the
    picture covers `coarseness` x `coarseness` of the view; `seconds_left` is None where unknown;
    about so many `letters` have room in a line.
    """
    found = [_progress(method, samples, wanted, coarseness, seconds_left)]
    if not stats.get('samples'):
        return found
    error = stats.get('estimated_error')
    found.append('Estimated error ' + ('—' if error is None else f'{error * 100:.3g} %'))
    found += filter(None, (_times(stats), _skipped(stats, letters)))
    return found


def _progress(method, samples, wanted, coarseness, seconds_left):
    text = f'{METHODS.get(method, method)}, '
    text += f'{samples} samples' if samples >= wanted else f'sample {samples} of {wanted}'
    if coarseness > 1:
        text += f', 1/{coarseness} of the resolution'
    return text + left(seconds_left)


def left(seconds):
    """Return ', 0:12 left', or nothing where that is unknown or about to end."""
    return '' if seconds is None or seconds < 1.0 else f', {clock(seconds)} left'


def _words(name):
    return name.replace('_', ' ')


def _times(stats):
    """Return the line of what takes how long, a sample on the mean; '' where nothing was measured."""
    effects, passes = stats.get('effects', ()), stats.get('passes', ())
    # Effects include the passes whose names begin with theirs; other passes serve several effects.
    known = tuple(f'{e["name"]}_' for e in effects)
    shared = [p for p in passes if not f'{p["name"]}_'.startswith(known)]
    timed = [e for e in (*effects, *shared) if e.get('runs', True) and e['ms']]
    timed.sort(key=lambda e: -e['ms'])
    named = [(_words(e['name']), e['ms']) for e in timed[:_MOST_TIMED]]
    rest = sum(p['ms'] or 0.0 for p in passes) - sum(ms for _, ms in named)
    samples = stats['samples']
    # Less is not to be seen.
    if rest / samples >= 0.05:
        named.append(('the rest', rest))
    return 'A sample: ' + ', '.join(f'{name} {ms / samples:.1f} ms' for name, ms in named) if named else ''


def _skipped(stats, letters):
    """Return the line of what was skipped and why; '' for nothing.

    Effects that have the same reason stand together.
    """
    by_reason = {}
    idle = [e for e in stats.get('effects', ()) if not e['runs'] and not e['name'].startswith('pass_')]
    for effect in sorted(idle, key=lambda e: _MAIN.index(e['name']) if e['name'] in _MAIN else len(_MAIN)):
        by_reason.setdefault(effect['reason'], []).append(_words(effect['name']))
    if not by_reason:
        return ''
    text, named = 'Skipped: ', 0
    for reason, names in by_reason.items():
        names = names[:_MOST_OF_A_REASON]
        part = f'{", ".join(names)} ({reason})'
        if named and len(text) + len(part) + len(_MORE) > letters:
            break
        text += (', ' if named else '') + part
        named += len(names)
    return text + (_MORE.format(len(idle) - named) if named < len(idle) else '')
