# SPDX-License-Identifier: GPL-3.0-or-later
"""Each kind of edit uploads what it touched and no more: from bpy through the add-on's sync to the GPU.

What a frame uploads whatever was edited (views, placed lamps) is measured first and taken
off. Bounds are sizes, in bytes, of what native/gpu_scene keeps of each thing.
"""

import bpy
import pytest

from building import Sync, add_object, grid, principled, quad
from panoptes import native, requests

OBJECTS = 1000
SIDE = 64
VEC4 = 16
# An instance, and one of its draws (record and command).
INSTANCE, DRAW = 64, 16 + 20
# A mesh's record in the tables, with its bounds and a word for each attribute name.
MESH_RECORD = (9 + 8) * 4
POSITION, TRIANGLE, UV_CORNER = 12, 12 + 12, 8
# What views and one lamp may cost a frame, whatever was edited: some blocks of a few hundred bytes.
FRAME = 4096
# The block of one view that the scene is drawn from.
VIEW = 240
# Equal bytes between two edited places are sent along up to these distances: tables, geometry.
GAP, MESH_GAP = 256, 64 * 12


class Uploads:
    """A scene that is shown; `of` tells what an edit of it costs."""

    def __init__(self, scene, engine):
        self.scene = scene
        self.engine = engine
        self.sync = Sync(self)
        self.frame = None
        # The first frame holds everything; the second is what any frame costs.
        self._render()
        self._render()
        self.frame = self._render()
        # What lamps see anew is drawn into their maps, whose views are sent.
        def edit():
            bpy.data.lights['Lamp'].energy = 2.0
        self.relit, _ = self.of(edit)

    def __getattr__(self, name):
        return getattr(self.engine, name)

    def clear(self):
        """Satisfy `Sync`, which counts calls when its engine is a recorder."""

    def names(self):
        """Satisfy `Sync`."""

    def _render(self, frame=None):
        self.sync.run(frame)
        before = self.engine.counters()
        request = requests.final(bpy.context.evaluated_depsgraph_get(), ('Combined',), pytest.fail)
        job = self.engine.render(request)
        while not job.wait(1.0):
            pass
        job.finish()
        after = self.engine.counters()
        return {name: after[name] - before[name] for name in after}

    def of(self, edit, frame=None):
        """Return (bytes beyond any frame's, programs compiled) of an edit."""
        edit()
        cost = self._render(frame)
        return cost['uploaded_bytes'] - self.frame['uploaded_bytes'], cost['programs']


def assert_sent(uploads, edit, due, programs=0, frame=None, lamps_see=True):
    """An edit sends something, and no more than `due` bytes; where lamps see it, their views besides."""
    sent, compiled = uploads.of(edit, frame)
    assert 0 < sent - (uploads.relit if lamps_see else 0) <= due
    assert compiled == programs


def material(name, color):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    principled(made).inputs['Base Color'].default_value = (*color, 1.0)
    return made


@pytest.fixture
def uploads(scene, native_module):
    """A thousand objects without indirect light, which is gathered anew after most edits and sent then."""
    scene.panoptes.radiance_cache.enabled = False
    return thousand_objects(scene)


def thousand_objects(scene):
    """Return the `Uploads` of tiles of one mesh over a ground, under a sun and a grey world."""
    native.use_factory(None)
    scene.render.resolution_x, scene.render.resolution_y = 16, 12
    scene.panoptes.realtime.shadow_resolution = 64
    scene.camera.location = (0.0, 0.0, 30.0)
    red, green = material('Red', (1, 0, 0)), material('Green', (0, 1, 0))
    tile = quad('Tile')
    tile.materials.append(red)
    for i in range(OBJECTS):
        add_object(tile, f'Tile {i}', location=(i % 40 - 20, i // 40 - 12, 0))
    ground = grid('Ground', SIDE)
    ground.materials.append(green)
    add_object(ground, 'Ground', location=(0, 0, -1), scale=(20, 20, 1))
    light = bpy.data.lights.new('Lamp', 'SUN')
    light.angle = 0.0  # without a penumbra its map is kept until something changes
    add_object(light, 'Lamp', location=(0, 0, 5))
    scene.world = bpy.data.worlds.new('World')
    scene.world.use_nodes = True
    bpy.context.view_layer.update()
    return Uploads(scene, native.engine())


class TestFrames:
    """What is paid without an edit."""

    def test_a_frame_sends_its_views_and_lamps(self, uploads):
        assert uploads.frame['uploaded_bytes'] + uploads.relit <= FRAME
        for name in ('programs', 'buffers', 'textures', 'memory_bytes'):
            assert uploads.frame[name] == 0, name

    def test_nothing_edited(self, uploads):
        assert uploads.of(lambda: None) == (0, 0)

    def test_camera(self, uploads):
        def edit():
            uploads.scene.camera.location.x = 1.0
        # Ambient occlusion's pair of phantom views stands beside the camera: both are drawn anew.
        assert uploads.of(edit) == (2 * VIEW, 0)


class TestObjects:
    """One of a thousand."""

    def test_transform(self, uploads):
        def edit():
            bpy.data.objects['Tile 7'].rotation_euler = (0.5, 0.25, 0.125)
        assert_sent(uploads, edit, INSTANCE)

    def test_frame_change(self, uploads):
        def animate():
            for frame in (1, 10):
                bpy.data.objects['Tile 9'].location.z = frame / 10
                bpy.data.objects['Tile 9'].keyframe_insert('location', frame=frame)
        uploads.of(animate)
        assert_sent(uploads, lambda: None, INSTANCE, frame=5)

    def test_hide_and_show(self, uploads):
        for hidden in (True, False):
            def edit():
                bpy.data.objects['Tile 3'].hide_viewport = hidden
            # The last one fills the hole, or the shown one comes last.
            assert_sent(uploads, edit, INSTANCE + 2 * DRAW + GAP)

    def test_ray_visibility(self, uploads):
        def hide(name):
            bpy.data.objects[name].visible_shadow = False
        # The list of what lamps do not see is made with room to spare.
        uploads.of(lambda: hide('Tile 4'))
        assert_sent(uploads, lambda: hide('Tile 5'), INSTANCE + 3 * DRAW)

    def test_add(self, uploads):
        def edit():
            mesh = quad('New')
            mesh.materials.append(bpy.data.materials['Green'])
            add_object(mesh, 'A new one', location=(3, 3, 2))
        assert_sent(uploads, edit, 4 * POSITION + 2 * TRIANGLE + MESH_RECORD + INSTANCE + DRAW)

    def test_add_with_a_material(self, uploads):
        def edit():
            mesh = quad('New')
            mesh.materials.append(material('Blue', (0, 0, 1)))
            add_object(mesh, 'A new one', location=(3, 3, 2))
        # The same code as the other materials': no program either.
        assert_sent(uploads, edit, 4 * POSITION + 2 * TRIANGLE + MESH_RECORD + INSTANCE + DRAW
                    + 8 * VEC4)

    def test_duplicate(self, uploads):
        def edit():
            add_object(bpy.data.meshes['Tile'], 'A twin', location=(3, 3, 2))
        assert_sent(uploads, edit, INSTANCE + DRAW)

    def test_delete(self, uploads):
        def edit():
            bpy.data.objects.remove(bpy.data.objects['Tile 5'])
        assert_sent(uploads, edit, INSTANCE + 2 * DRAW + GAP)

    def test_undo(self, uploads):
        bpy.ops.ed.undo_push(message='before')
        bpy.data.objects['Tile 7'].location.z = 0.5
        bpy.ops.ed.undo_push(message='moved')
        uploads.of(lambda: None)
        assert_sent(uploads, bpy.ops.ed.undo, INSTANCE)


class TestMeshes:
    """A mesh of thousands of triangles beside a thousand others."""

    def test_one_vertex(self, uploads):
        def edit():
            mesh = bpy.data.meshes['Ground']
            mesh.vertices[100].co.z = 0.1
            mesh.update()
        # It, the normals of the four faces around it (two rows of two), and the mesh's bounds.
        assert_sent(uploads, edit, POSITION + 2 * (4 * 12) + MESH_GAP + MESH_RECORD)

    def test_all_vertices(self, uploads):
        def edit():
            mesh = bpy.data.meshes['Ground']
            for vertex in mesh.vertices:
                vertex.co.z = vertex.co.x ** 2
            mesh.update()
        # Positions and normals; neither indices nor texture coordinates.
        assert_sent(uploads, edit, (SIDE + 1) ** 2 * POSITION + SIDE ** 2 * 2 * 12 + MESH_RECORD)

    def test_topology(self, uploads):
        side = SIDE - 1
        def edit():
            old = bpy.data.meshes['Ground']
            bpy.data.objects['Ground'].data = grid('Smaller', side)
            bpy.data.objects['Ground'].data.materials.append(bpy.data.materials['Green'])
            bpy.data.meshes.remove(old)
        triangles = side ** 2 * 2
        assert_sent(uploads, edit, (side + 1) ** 2 * POSITION
                    + triangles * (TRIANGLE + 3 * UV_CORNER) + MESH_RECORD + INSTANCE + DRAW)


class TestShading:
    """Materials, lamps and the world."""

    def test_material_value(self, uploads):
        def edit():
            color = principled(bpy.data.materials['Red']).inputs['Base Color']
            color.default_value = (0.5, 0.25, 0.125, 1.0)
        assert_sent(uploads, edit, VEC4, lamps_see=False)

    def test_node_link(self, uploads):
        def edit():
            tree = bpy.data.materials['Green'].node_tree
            node = tree.nodes.new('ShaderNodeTexCoord')
            color = principled(bpy.data.materials['Green']).inputs['Base Color']
            tree.links.new(node.outputs['UV'], color)
        # Its parameters; one program, that of its surfaces.
        assert_sent(uploads, edit, 8 * VEC4, programs=1)

    def test_lamp(self, uploads):
        def edit():
            bpy.data.lights['Lamp'].energy = 3.0
        assert uploads.of(edit) == (uploads.relit, 0)

    def test_world_colour(self, uploads):
        def edit():
            tree = uploads.scene.world.node_tree
            node = next(n for n in tree.nodes if n.type == 'BACKGROUND')
            node.inputs['Color'].default_value = (0.5, 0.0, 1.0, 1.0)
        # Its parameters, and nine coefficients of its light.
        assert_sent(uploads, edit, 2 * VEC4 + 9 * VEC4, lamps_see=False)


class TestIndirectLight:
    """What it adds where it is on."""

    @pytest.fixture
    def lit(self, scene, native_module):
        return thousand_objects(scene)

    def test_a_resting_scene_sends_nothing_for_it(self, lit):
        assert lit.frame['uploaded_bytes'] + lit.relit <= FRAME
        assert lit.of(lambda: None) == (0, 0)

    def test_strength_on_an_object(self, lit):
        def edit():
            bpy.data.objects['Tile 6'].panoptes.indirect_luminance = 0.5
        # Neither does it have to be gathered anew, nor do lamps see anything of it: two halves, and the block of all
        # scales, which the programs of a scene without any know nothing of.
        assert lit.of(edit)[0] == 4 + 672
        assert lit.of(lambda: None) == (672, 0)
