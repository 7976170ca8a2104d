# SPDX-License-Identifier: GPL-3.0-or-later
"""Where indirect light is stronger or weaker: regions, and scales of objects on their way to the native side."""

import math

import bpy
import numpy as np
import pytest

from building import Sync, add_object, quad
from test_paths import viewport
from test_radiance_cache import sent


class TestRegions:
    """Boxes with scales of their own."""

    @pytest.fixture
    def boxes(self, scene):
        """The chosen collection, empty."""
        scene.panoptes.radiance_cache.region_collection = found = bpy.data.collections.new('Boxes')
        scene.collection.children.link(found)
        return found

    @staticmethod
    def empty(boxes, name='Empty', size=1.0, **settings):
        thing = bpy.data.objects.new(name, None)
        thing.empty_display_type, thing.empty_display_size = 'CUBE', size
        for key, value in settings.items():
            setattr(thing, key, value)
        boxes.objects.link(thing)
        return thing

    @staticmethod
    def in_box(place, warn=pytest.fail):
        """Return where a place in the world is in the only region."""
        (region,) = sent(warn)['regions']
        x, y, z, w = np.array(region['world_to_box']) @ (*place, 1.0)
        assert w == pytest.approx(1.0)
        return x, y, z

    def test_none(self, boxes):
        assert sent()['regions'] == []

    def test_scales(self, boxes):
        thing = self.empty(boxes)
        thing.panoptes.indirect_luminance, thing.panoptes.indirect_chrominance = 0.25, 2.0
        (region,) = sent()['regions']
        assert region == {'world_to_box': np.eye(4).tolist(), 'luminance': 0.25, 'chrominance': 2.0}
        # A 3D View tells its pictures apart by their requests.
        before = repr(viewport()['settings'])
        thing.panoptes.indirect_luminance = 0.5
        assert repr(viewport()['settings']) != before

    def test_empty(self, boxes):
        self.empty(boxes, size=2.0, location=(1.0, 2.0, 3.0), scale=(1.0, 2.0, 0.5))
        assert self.in_box((3.0, 6.0, 4.0)) == pytest.approx((1.0, 1.0, 1.0))
        assert self.in_box((1.0, 2.0, 2.0)) == pytest.approx((0.0, 0.0, -1.0))

    def test_rotated(self, boxes):
        self.empty(boxes, rotation_euler=(0.0, 0.0, math.pi / 2.0), scale=(4.0, 1.0, 1.0))
        assert self.in_box((0.0, 4.0, 0.0)) == pytest.approx((1.0, 0.0, 0.0), abs=1e-6)

    def test_mirrored(self, boxes):
        self.empty(boxes, scale=(-2.0, 1.0, 1.0))
        assert self.in_box((2.0, 1.0, 0.0)) == pytest.approx((-1.0, 1.0, 0.0))

    def test_sheared_by_parents(self, boxes):
        parent = self.empty(boxes, 'Parent', scale=(3.0, 1.0, 1.0))
        boxes.objects.unlink(parent)
        bpy.context.scene.collection.objects.link(parent)
        self.empty(boxes, parent=parent, rotation_euler=(0.0, 0.0, math.pi / 4.0))
        half = math.sqrt(0.5)
        assert self.in_box((3.0 * half, half, 0.0)) == pytest.approx((1.0, 0.0, 0.0), abs=1e-6)

    def test_mesh(self, boxes):
        mesh = bpy.data.meshes.new('Box')
        mesh.from_pydata([(0, 0, 0), (2, 0, 0), (0, 4, 0), (0, 0, 6)], [], [(0, 1, 2), (0, 1, 3)])
        thing = bpy.data.objects.new('Box', mesh)
        thing.location.x = 10.0
        boxes.objects.link(thing)
        assert self.in_box((11.0, 2.0, 3.0)) == pytest.approx((0.0, 0.0, 0.0), abs=1e-6)
        assert self.in_box((12.0, 4.0, 6.0)) == pytest.approx((1.0, 1.0, 1.0), abs=1e-6)

    def test_mesh_with_modifiers(self, boxes):
        thing = bpy.data.objects.new('Box', quad())
        thing.modifiers.new('Thick', 'SOLIDIFY').thickness = 0.5
        boxes.objects.link(thing)
        assert self.in_box((1.0, 1.0, 0.0)) == pytest.approx((1.0, 1.0, 1.0), abs=1e-5)
        assert self.in_box((0.0, 0.0, -0.5)) == pytest.approx((-1.0, -1.0, -1.0), abs=1e-5)

    def test_far_away_and_tiny(self, boxes):
        self.empty(boxes, location=(2.0 ** 20, 0.0, 0.0), scale=(0.125,) * 3)
        assert self.in_box((2.0 ** 20 + 0.125, 0.0, 0.0)) == pytest.approx((1.0, 0.0, 0.0))
        boxes.objects[0].scale = (1e-4,) * 3
        assert len(sent()['regions']) == 1

    @pytest.mark.parametrize('scale', [(0.0, 1.0, 1.0), (0.0, 0.0, 0.0), (1.0, 1.0, 0.0)])
    def test_flat(self, boxes, scale):
        self.empty(boxes, 'A', scale=scale)
        self.empty(boxes, 'B', location=(5.0, 0.0, 0.0))
        said = []
        assert self.in_box((5.0, 0.0, 0.0), said.append) == pytest.approx((0.0, 0.0, 0.0))
        assert len(said) == 1 and "'A' is flat" in said[0]

    def test_flat_mesh(self, boxes):
        boxes.objects.link(bpy.data.objects.new('Quad', quad()))
        said = []
        assert sent(said.append)['regions'] == []
        assert len(said) == 1 and "'Quad' is flat" in said[0]

    def test_nowhere(self, boxes):
        self.empty(boxes, location=(math.nan, 0.0, 0.0))
        said = []
        assert sent(said.append)['regions'] == []
        assert len(said) == 1 and "'Empty'" in said[0] and 'not a number' in said[0]

    def test_what_is_no_box(self, boxes):
        self.empty(boxes, 'Arrows', empty_display_type='ARROWS')
        boxes.objects.link(bpy.data.objects.new('Lamp', bpy.data.lights.new('Lamp', 'POINT')))
        said = []
        assert sent(said.append)['regions'] == []
        assert len(said) == 1 and "'Arrows', 'Lamp'" in said[0] and "'Boxes'" in said[0]

    def test_no_more_than_eight(self, boxes):
        for x in range(10):
            self.empty(boxes, f'{x}', location=(x, 0.0, 0.0))
        said = []
        found = [-region['world_to_box'][0][3] for region in sent(said.append)['regions']]
        assert found == pytest.approx(range(8))
        assert len(said) == 1 and 'first by name' in said[0]

    def test_animation(self, scene, boxes):
        thing = self.empty(boxes)
        for frame, x in ((1, 0.0), (11, 10.0)):
            thing.location.x = thing.panoptes.indirect_luminance = x
            thing.keyframe_insert('location', frame=frame)
            thing.keyframe_insert('panoptes.indirect_luminance', frame=frame)
        for frame, x in ((1, 0.0), (11, 10.0), (1, 0.0)):
            scene.frame_set(frame)
            assert self.in_box((x, 0.0, 0.0)) == pytest.approx((0.0, 0.0, 0.0))
            assert sent()['regions'][0]['luminance'] == pytest.approx(x)


class TestObjects:
    """Scales of single objects, on their way to the native scene."""

    @pytest.fixture
    def sync(self, scene, recorder):
        return Sync(recorder)

    @staticmethod
    def scales(sync):
        """Return the scales of the last list of instances."""
        found = sync.recorder.arguments('set_instances')[-1][5]
        assert found.dtype == np.float32
        return found.tolist()

    @staticmethod
    def scale(thing, luminance, chrominance=1.0):
        thing.panoptes.indirect_luminance, thing.panoptes.indirect_chrominance = luminance, chrominance

    def test_defaults(self, sync):
        thing = add_object(quad())
        sync.run()
        assert self.scales(sync) == [[1.0, 1.0]]
        # Looking at ten thousand objects leaves nothing behind in any.
        assert not thing.is_property_set('panoptes')

    def test_values(self, sync):
        self.scale(add_object(quad(), 'A'), 0.5, 2.0)
        self.scale(add_object(quad(), 'B'), 0.0)
        sync.run()
        assert self.scales(sync) == [[0.5, 2.0], [0.0, 1.0]]

    def test_change_sends_the_scale_alone(self, sync):
        add_object(quad(), 'A')
        thing = add_object(quad(), 'B')
        sync.run()
        state = sync.mirror.state()
        thing.panoptes.indirect_chrominance = 0.25
        assert sync.run()[0] == ['set_instance_scales']
        ((indices, scales),) = sync.recorder.arguments('set_instance_scales')
        assert (indices.tolist(), scales.tolist()) == ([1], [[1.0, 0.25]])
        assert indices.dtype == np.int32 and scales.dtype == np.float32
        # A 3D View begins a new picture for it.
        assert sync.mirror.state() != state
        assert sync.full()[0] == []

    def test_with_a_move(self, sync):
        thing = add_object(quad())
        sync.run()
        self.scale(thing, 0.5)
        thing.location.x = 1.0
        assert sync.run()[0] == ['set_instance_matrices', 'set_instance_scales']

    def test_animation(self, sync):
        thing = add_object(quad())
        for frame, value in ((1, 0.0), (11, 1.0)):
            thing.panoptes.indirect_luminance = value
            thing.keyframe_insert('panoptes.indirect_luminance', frame=frame)
        bpy.context.scene.frame_set(1)
        sync.run()
        assert self.scales(sync) == [[0.0, 1.0]]
        assert sync.run(frame=11)[0] == ['set_instance_scales']
        assert sync.recorder.arguments('set_instance_scales')[0][1].tolist() == [[1.0, 1.0]]

    def test_instances_have_their_makers_too(self, sync):
        leaf = bpy.data.objects.new('Leaf', quad())
        self.scale(leaf, 0.5, 0.5)
        leaves = bpy.data.collections.new('Leaves')
        leaves.objects.link(leaf)
        self.scale(add_object(None, 'Instancer', instance_type='COLLECTION', instance_collection=leaves), 3.0)
        sync.run()
        assert self.scales(sync) == [[1.5, 0.5]]

    def test_what_is_no_number(self, sync):
        self.scale(add_object(quad(), 'Odd'), math.nan)
        _, report = sync.run()
        assert self.scales(sync) == [[1.0, 1.0]]
        assert len(report.warnings) == 1 and "'Odd'" in report.warnings[0]

    def test_undo(self, sync):
        add_object(quad(), 'Thing')
        bpy.ops.ed.undo_push(message='before')
        sync.run()
        self.scale(bpy.data.objects['Thing'], 0.5)
        bpy.ops.ed.undo_push(message='changed')
        sync.run()
        bpy.ops.ed.undo()
        assert sync.run()[0] == ['set_instance_scales']
        assert sync.recorder.arguments('set_instance_scales')[0][1].tolist() == [[1.0, 1.0]]
