# SPDX-License-Identifier: GPL-3.0-or-later
"""What the native engine holds at the moment, and the least that brings it up to date.

The engine is shared by viewports and final renders, each of which wants its own version of the
scene. They all write through one `Mirror`, which remembers what was sent and sends differences only.
"""

import numpy as np

from .summary import summary


class Mirror:
    """The native scene as last written. All ids are positive and belong to keys chosen by callers.

    `owner` is whoever wrote last: a sync that finds another owner cannot rely on what it remembers
    of its own last pass.
    """

    def __init__(self, engine):
        self.engine = engine
        self.owner = None
        self._next_id = 1
        self._ids = {}
        self._meshes = {}
        self._materials = {}
        self._images = {}
        self._lights = None
        self._world = None
        self._instances = None

    def state(self):
        """Return a hashable summary of all that is held; equal states give equal pictures."""
        return hash(summary((self._meshes, self._materials, self._images, self._lights, self._world,
                             self._instances)))

    def id_of(self, kind, key):
        """Return the id of `key` among 'mesh', 'material' or 'image' things.

        It stays the same for as long as the mirror lives, so that a thing that is hidden and shown
        again leads to the same `state`.
        """
        full = (kind, key)
        if full not in self._ids:
            self._ids[full] = self._next_id
            self._next_id += 1
        return self._ids[full]

    # Meshes

    def has_mesh(self, mesh_id):
        """Tell whether the engine holds this mesh."""
        return mesh_id in self._meshes

    def put_mesh(self, mesh_id, mesh):
        """Send an extracted mesh unless the engine holds the same bits; return whether it was sent."""
        mark = mesh.fingerprint
        if self._meshes.get(mesh_id) == mark:
            return False
        self._meshes.pop(mesh_id, None)
        self.engine.set_mesh(mesh_id, *mesh.arguments())
        self._meshes[mesh_id] = mark
        return True

    # Materials and the world

    def put_material(self, material_id, name, shader, textures):
        """Send a `CompiledShader` whose textures are [(image id, interpolation, extension)].

        Where only values differ, only the block of values is sent.
        """
        structure = (shader.code, tuple(textures), _frozen(shader.facts), shader.params.shape)
        values = shader.params.tobytes()
        held = self._materials.get(material_id)
        if held is None or held[0] != structure:
            self._materials.pop(material_id, None)
            self.engine.set_material(material_id, name, shader.code, shader.params, textures,
                                     dict(shader.facts, least_roughness=shader.least_roughness))
        elif held[1] != values:
            self.engine.set_material_params(material_id, shader.params, shader.least_roughness)
        self._materials[material_id] = (structure, values)

    def put_world(self, shader, textures):
        """Send the world's `CompiledShader`."""
        mark = (shader.code, tuple(textures), shader.params.tobytes(), shader.constant)
        if mark != self._world:
            self._world = None
            self.engine.set_world(shader.code, shader.params, textures, shader.constant)
            self._world = mark

    # Images

    def image_is_current(self, image_id, mark):
        """Tell whether the engine holds this image in the state that `mark` names."""
        return image_id in self._images and self._images[image_id] == mark

    def note_image(self, image_id, mark):
        """Remember that an image was sent in the state that `mark` names."""
        self._images[image_id] = mark

    # Lights and instances

    def put_lights(self, lights):
        """Send the list of light dictionaries if it differs from what the engine holds."""
        mark = [tuple((k, v.tobytes() if isinstance(v, np.ndarray) else v) for k, v in light.items())
                for light in lights]
        if mark != self._lights:
            self._lights = None
            self.engine.set_lights(lights)
            self._lights = mark

    def put_instances(self, mesh_ids, matrices, offsets, table, visibility, indirect_scales):
        """Send instances: all of them if the list changed, else only matrices and scales that did.

        `visibility` is uint8[N] of the bits in shaders/scene/visibility_shared.h, `indirect_scales` is
        float32[N, 2].
        """
        held = self._instances
        listed = (mesh_ids, offsets, table, visibility)
        same_list = held is not None and all(map(np.array_equal, held[0], listed))
        self._instances = None
        if not same_list:
            self.engine.set_instances(mesh_ids, matrices, offsets, table, visibility, indirect_scales)
        else:
            moved = np.flatnonzero((held[1] != matrices).any(axis=(1, 2))).astype(np.int32)
            if len(moved):
                self.engine.set_instance_matrices(moved, np.ascontiguousarray(matrices[moved]))
            scaled = np.flatnonzero((held[2] != indirect_scales).any(axis=1)).astype(np.int32)
            if len(scaled):
                self.engine.set_instance_scales(scaled, np.ascontiguousarray(indirect_scales[scaled]))
        self._instances = (listed, matrices, indirect_scales)

    def keep_only(self, meshes, materials, images):
        """Remove whatever is not in these sets of ids."""
        for held, wanted, remove in ((self._meshes, meshes, self.engine.remove_mesh),
                                     (self._materials, materials, self.engine.remove_material),
                                     (self._images, images, self.engine.remove_image)):
            for unused in [i for i in held if i not in wanted]:
                remove(unused)
                del held[unused]


def _frozen(facts):
    return tuple(sorted((k, tuple(v) if isinstance(v, list) else v) for k, v in facts.items()))
