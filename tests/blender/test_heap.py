# SPDX-License-Identifier: GPL-3.0-or-later
"""The memory of the software rasteriser, where Blender's is jemalloc's: apart from Blender's own."""

import ctypes
import os
import subprocess

import bpy
import pytest

HERE = os.path.dirname(os.path.abspath(__file__))

# Prints how many arenas there are, before and after an engine has been made, another, and a picture.
SCRIPT = f'''
import ctypes, sys
sys.path.insert(0, {os.path.join(HERE, '..', '..', 'addon')!r})

def arenas():
    count, size = ctypes.c_uint(), ctypes.c_size_t(4)
    assert ctypes.CDLL(None).mallctl(b'arenas.narenas', ctypes.byref(count), ctypes.byref(size), None, 0) == 0
    return count.value

before = arenas()
from panoptes import native
engine = native.module().Engine(prefer_software=True)
first = arenas()
other = native.module().Engine(prefer_software=True)
print('arenas', before, first, arenas(), flush=True)
other.close()
engine.close()
'''


def test_threads_that_draw_have_an_arena_of_their_own(native_module):
    if not hasattr(ctypes.CDLL(None), 'mallctl'):
        pytest.skip('this Blender does not use jemalloc, or hides it')
    done = subprocess.run([bpy.app.binary_path, '-b', '--factory-startup', '--python-expr', SCRIPT],
                          capture_output=True, text=True, timeout=120, check=False)
    line = next((line for line in done.stdout.splitlines() if line.startswith('arenas')), done.stdout + done.stderr)
    before, first, second = (int(word) for word in line.split()[1:])
    assert first == before + 1 and second == first
