# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts of sentences for artists."""

_MOST_NAMED = 3


def listed(names):
    """Return "'A', 'B', 'C' and 2 more"."""
    shown = ', '.join(f"'{name}'" for name in names[:_MOST_NAMED])
    return shown + (f' and {len(names) - _MOST_NAMED} more' if len(names) > _MOST_NAMED else '')
