# SPDX-License-Identifier: GPL-3.0-or-later
"""Ray visibility of objects and of what makes instances, by Cycles' rules."""

import bpy
import numpy as np
import pytest

from building import Sync, add_object, quad
from panoptes.sync import visibility

SWITCHES = {'camera': 1, 'diffuse': 2, 'glossy': 4, 'transmission': 8, 'volume_scatter': 16, 'shadow': 32}


@pytest.fixture
def sync(scene, recorder):
    return Sync(recorder)


def bits(sync):
    """The visibility of the last list of instances."""
    found = sync.recorder.arguments('set_instances')[-1][4]
    assert found.dtype == np.uint8
    return found.tolist()


def collection_of(*things):
    found = bpy.data.collections.new('Collection')
    for thing in things:
        found.objects.link(thing)
    return found


def instancer(collection, **settings):
    return add_object(None, 'Instancer', instance_type='COLLECTION', instance_collection=collection,
                      **settings)


def test_each_switch(sync):
    add_object(quad(), 'All')
    for name in SWITCHES:
        add_object(quad(), name, **{f'visible_{name}': False})
    sync.run()
    assert bits(sync) == [63] + [63 - bit for bit in SWITCHES.values()]


def test_nobody_sees_it(sync):
    add_object(quad(), **{f'visible_{name}': False for name in SWITCHES})
    sync.run()
    assert bits(sync) == [] and sync.recorder.arguments('set_mesh') == []


def test_change_is_sent(sync):
    thing = add_object(quad())
    sync.run()
    thing.visible_glossy = False
    names, report = sync.run()
    assert names == ['set_instances'] and report.meshes_extracted == 0 and bits(sync) == [59]


def test_instances_need_their_maker_too(sync):
    leaf = bpy.data.objects.new('Leaf', quad())
    leaf.visible_diffuse = False
    instancer(collection_of(leaf), visible_camera=False)
    sync.run()
    assert bits(sync) == [63 - 1 - 2]


def test_particles_need_their_emitter_too(sync):
    leaf = add_object(quad(), 'Leaf', visible_diffuse=False)
    emitter = add_object(quad('Emitter'), 'Emitter', visible_shadow=False)
    settings = emitter.modifiers.new('Particles', 'PARTICLE_SYSTEM').particle_system.settings
    settings.type, settings.count = 'HAIR', 3
    settings.render_type, settings.instance_object = 'OBJECT', leaf
    sync.run()
    assert sorted(bits(sync)) == [63 - 2 - 32] * 3 + [63 - 32] + [63 - 2]


def test_indirect_only_collections(sync):
    extra = collection_of(bpy.data.objects.new('Extra', quad()))
    bpy.context.scene.collection.children.link(extra)
    bpy.context.view_layer.layer_collection.children[extra.name].indirect_only = True
    _, report = sync.run()
    assert bits(sync) == [62] and report.warnings == []


@pytest.mark.parametrize('where', ['object', 'collection', 'instancer'])
def test_holdouts_are_plain_and_named(sync, where):
    leaf = bpy.data.objects.new('Leaf', quad())
    extra = collection_of(leaf)
    if where == 'instancer':
        instancer(extra, is_holdout=True)
    else:
        bpy.context.scene.collection.children.link(extra)
        leaf.is_holdout = where == 'object'
        bpy.context.view_layer.layer_collection.children[extra.name].holdout = where == 'collection'
    _, report = sync.run()
    assert bits(sync) == [63] and len(report.warnings) == 1
    assert "'Leaf'" in report.warnings[0] and 'holdout' in report.warnings[0]


def test_shadow_catchers_are_plain_and_named(sync):
    add_object(quad(), 'Floor', is_shadow_catcher=True)
    _, report = sync.run()
    assert bits(sync) == [63] and len(report.warnings) == 1
    assert "'Floor'" in report.warnings[0] and 'shadow catcher' in report.warnings[0]


@pytest.mark.parametrize('hidden', ['nothing', 'leaf', 'maker', 'indirect only'])
def test_cycles_agrees_about_the_camera(sync, tmp_path, hidden):
    """Whether the camera sees an instance, rendered by Cycles."""
    scene = bpy.context.scene
    leaf = bpy.data.objects.new('Leaf', quad())
    leaf.scale, leaf.location = (100, 100, 1), (-50, -50, 0)
    inner = collection_of(leaf)
    maker = instancer(inner)
    leaf.visible_camera = hidden != 'leaf'
    maker.visible_camera = hidden != 'maker'
    if hidden == 'indirect only':
        extra = collection_of(maker)
        scene.collection.objects.unlink(maker)
        scene.collection.children.link(extra)
        bpy.context.view_layer.layer_collection.children[extra.name].indirect_only = True
    sync.run()
    ours = bool(bits(sync)[0] & visibility.CAMERA)

    scene.render.engine = 'CYCLES'
    scene.cycles.samples, scene.cycles.device = 1, 'CPU'
    scene.cycles.use_denoising = scene.cycles.use_adaptive_sampling = False
    scene.render.resolution_x = scene.render.resolution_y = 4
    scene.render.film_transparent = True
    scene.render.filepath = str(tmp_path / 'seen.exr')
    scene.render.image_settings.file_format = 'OPEN_EXR'
    scene.render.image_settings.color_mode = 'RGBA'
    bpy.ops.render.render(write_still=True)
    pixels = np.empty((4, 4, 4), np.float32)
    bpy.data.images.load(scene.render.filepath).pixels.foreach_get(pixels.reshape(-1))
    assert ours == bool(pixels[2, 2, 3] > 0.5) == (hidden == 'nothing')
