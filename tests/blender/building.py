# SPDX-License-Identifier: GPL-3.0-or-later
"""Building scenes in tests, and synchronising them with a recorder."""

import bpy
import numpy as np

from panoptes.sync import Mirror, SceneSync


class Sync:
    """A mirror over the recorder, with one `SceneSync` that is told of every change."""

    def __init__(self, recorder):
        self.recorder = recorder
        self.mirror = Mirror(recorder)
        self.scene_sync = SceneSync()
        self.first = True

    def run(self, frame=None):
        """Evaluate what was edited (at another frame, if given) and synchronise.

        Updates are there only while Blender tells about them, so this happens inside a handler, as
        it does in `view_update`. Returns (calls as names, report).
        """
        self.recorder.clear()
        done = []

        def sync(_scene, depsgraph):
            done.append(self.scene_sync.sync(self.mirror, depsgraph, incremental=not self.first))

        handlers = (bpy.app.handlers.depsgraph_update_post if frame is None
                    else bpy.app.handlers.frame_change_post)
        handlers.append(sync)
        try:
            if frame is None:
                bpy.context.view_layer.update()
            else:
                bpy.context.scene.frame_set(frame)
        finally:
            handlers.remove(sync)
        if not done:
            # Nothing was edited.
            sync(None, bpy.context.evaluated_depsgraph_get())
        self.first = False
        return self.recorder.names(), done[0]

    def full(self):
        """Synchronise as a final render does: everything is read, differences are sent."""
        self.recorder.clear()
        depsgraph = bpy.context.evaluated_depsgraph_get()
        report = self.scene_sync.sync(self.mirror, depsgraph, incremental=False)
        self.first = False
        return self.recorder.names(), report


def add_object(data, name='Object', **settings):
    thing = bpy.data.objects.new(name, data)
    for key, value in settings.items():
        setattr(thing, key, value)
    bpy.context.scene.collection.objects.link(thing)
    return thing


def quad(name='Quad', materials=0):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [], [(0, 1, 2, 3)])
    for _ in range(materials):
        mesh.materials.append(bpy.data.materials.new('Material'))
    mesh.update()
    return mesh


def grid(name, side, size=2.0):
    """A square mesh of side * side quads with a UV map."""
    steps = np.linspace(-0.5, 0.5, side + 1) * size
    x, y = np.meshgrid(steps, steps)
    corners = np.stack([x, y, np.zeros_like(x)], -1).reshape(-1, 3)
    first = (np.arange(side)[:, None] * (side + 1) + np.arange(side)).reshape(-1, 1)
    places = first + [0, 1, side + 2, side + 1]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners.tolist(), [], places.tolist())
    uv = corners[places.ravel(), :2] / size + 0.5
    mesh.uv_layers.new(name='UVMap').data.foreach_set('uv', uv.astype(np.float32).ravel())
    mesh.update()
    return mesh


def principled(of_material):
    """The Principled node of a material."""
    return next(n for n in of_material.node_tree.nodes if n.type == 'BSDF_PRINCIPLED')


def cube():
    bpy.ops.mesh.primitive_cube_add()
    return bpy.context.object


def material_reading(name):
    """A material whose colour is the mesh attribute of this name."""
    material = bpy.data.materials.new(f'Reads {name}')
    material.use_nodes = True
    tree = material.node_tree
    node = tree.nodes.new('ShaderNodeAttribute')
    node.attribute_name = name
    tree.links.new(node.outputs['Color'], principled(material).inputs['Base Color'])
    return material
