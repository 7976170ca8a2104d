# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs pytest inside Blender: blender -b --factory-startup -P tests/blender/run.py -- [pytest args]."""

import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))


def main():
    """Run the tests of this folder; leave Blender with pytest's exit status."""
    import pytest

    sys.path.insert(0, os.path.join(ROOT, 'addon'))
    words = sys.argv[sys.argv.index('--') + 1:] if '--' in sys.argv else []
    if not any(not word.startswith('-') and os.path.exists(word.split('::')[0]) for word in words):
        words.append(HERE)
    status = pytest.main(['--rootdir', HERE, '-p', 'no:cacheprovider', *words])
    sys.stdout.flush()
    sys.exit(int(status))


if __name__ == '__main__':
    main()
