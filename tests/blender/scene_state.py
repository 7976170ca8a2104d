# SPDX-License-Identifier: GPL-3.0-or-later
"""A stand-in for the native engine that holds what its scene would hold, to compare states."""

import bpy

from panoptes.sync import Mirror, SceneSync, meshes


class SceneState:
    """Has the calls of `panoptes_native.Engine` that edit the scene."""

    def __init__(self):
        self.meshes, self.materials, self.images = {}, {}, {}
        self.instances = self.lights = self.world = None

    def set_mesh(self, mesh_id, *arguments):
        """Keep what tells the mesh from others."""
        mesh = (meshes.NativeMesh if len(arguments) == 1 else meshes.MeshArrays)(*arguments)
        self.meshes[mesh_id] = mesh.fingerprint

    def remove_mesh(self, mesh_id):
        del self.meshes[mesh_id]

    def set_material(self, material_id, name, code, params, textures, facts):
        self.materials[material_id] = [code, params.tobytes(), list(textures), dict(facts)]

    def set_material_params(self, material_id, params, least_roughness):
        self.materials[material_id][1] = params.tobytes()
        self.materials[material_id][3]['least_roughness'] = least_roughness

    def remove_material(self, material_id):
        del self.materials[material_id]

    def set_image_file(self, image_id, *arguments):
        self.images[image_id] = arguments

    set_image_encoded = set_image_pixels = set_image_file

    def remove_image(self, image_id):
        del self.images[image_id]

    def set_lights(self, lights):
        self.lights = [{key: getattr(value, 'tolist', lambda value=value: value)()
                        for key, value in light.items()} for light in lights]

    def set_world(self, code, params, textures, constant):
        self.world = (code, params.tobytes(), list(textures), constant)

    def set_instances(self, mesh_ids, matrices, offsets, table, visibility, scales):
        self.instances = [mesh_ids, matrices.copy(), offsets, table, visibility, scales.copy()]

    def set_instance_matrices(self, indices, matrices):
        self.instances[1][indices] = matrices

    def set_instance_scales(self, indices, scales):
        self.instances[5][indices] = scales

    def contents(self):
        """Return everything without ids, which depend on the order of edits."""
        mesh_ids, matrices, offsets, table, visibility, scales = self.instances

        def material(material_id):
            if material_id == 0:
                return None
            code, params, textures, facts = self.materials[material_id]
            return code, params, [(self.images[image], *rest) for image, *rest in textures], facts

        return {
            'instances': [(self.meshes[mesh], matrix.tolist(), offset, bits, scale)
                          for mesh, matrix, offset, bits, scale
                          in zip(mesh_ids.tolist(), matrices, offsets.tolist(), visibility.tolist(), scales.tolist())],
            'materials': [material(i) for i in table.tolist()],
            'lights': self.lights,
            'world': self.world,
            'held': (len(self.meshes), len(self.materials), len(self.images)),
        }


class Follower:
    """Synchronises with every evaluation of the scene, as a 3D View does.

    A context manager. Warnings of the last pass are in `report`.
    """

    def __init__(self):
        self.state = SceneState()
        self.mirror = Mirror(self.state)
        self.scene_sync = SceneSync()
        self.report = None
        self.extracted = 0
        self._handlers = (bpy.app.handlers.depsgraph_update_post,
                          bpy.app.handlers.frame_change_post)

    def __enter__(self):
        bpy.context.view_layer.update()
        self._sync(None, bpy.context.evaluated_depsgraph_get())
        for handlers in self._handlers:
            handlers.append(self._sync)
        return self

    def __exit__(self, *_):
        for handlers in self._handlers:
            handlers[:] = [handler for handler in handlers if handler != self._sync]

    def _sync(self, _scene, depsgraph):
        self.report = self.scene_sync.sync(self.mirror, depsgraph, incremental=self.report is not None)
        self.extracted += self.report.meshes_extracted

    def check(self):
        """Evaluate what was edited, and assert that a full synchronisation would hold the same."""
        bpy.context.view_layer.update()
        fresh = SceneState()
        report = SceneSync().sync(Mirror(fresh), bpy.context.evaluated_depsgraph_get(),
                                  incremental=False)
        found, wanted = self.state.contents(), fresh.contents()
        for part, value in wanted.items():
            assert found[part] == value, part
        assert self.report.warnings == report.warnings
