# SPDX-License-Identifier: GPL-3.0-or-later
"""Fixtures: an empty scene with the add-on registered, and stand-ins for the native engine."""

import os
import sys

import bpy
import pytest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import panoptes  # noqa: E402
from panoptes import native, session  # noqa: E402
from panoptes.sync import SceneSync, memory  # noqa: E402
from recorder import Recorder  # noqa: E402

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


@pytest.fixture(scope='session', autouse=True)
def _addon():
    panoptes.register()
    yield
    panoptes.unregister()


@pytest.fixture
def scene():
    """An empty scene with a camera and Panoptes chosen; 32x24 pixels, one sample."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = 'PANOPTES'
    scene.render.resolution_x, scene.render.resolution_y = 32, 24
    scene.render.resolution_percentage = 100
    scene.panoptes.samples = 1
    camera = bpy.data.objects.new('Camera', bpy.data.cameras.new('Camera'))
    camera.location = (0.0, 0.0, 10.0)
    scene.collection.objects.link(camera)
    scene.camera = camera
    session.start_final()
    session.final_sync = SceneSync()
    return scene


@pytest.fixture
def arrays_only(monkeypatch):
    """Meshes come as arrays in every version of Blender, so that tests can look at them."""
    monkeypatch.setattr(memory, 'read', lambda *arguments, **named: None)


@pytest.fixture
def recorder(arrays_only):
    """The engine that the add-on uses is a `Recorder`, and is returned."""
    engine = Recorder()
    native.use_factory(lambda: engine)
    yield engine
    native.use_factory(None)


@pytest.fixture(scope='session')
def native_module():
    """The real native module; the test is skipped where it was not built."""
    for folder in (os.path.join(ROOT, 'build', 'python'),):
        if os.path.isdir(folder) and folder not in sys.path:
            sys.path.append(folder)
    try:
        return native.module()
    except native.Unavailable as error:
        pytest.skip(str(error))
