# SPDX-License-Identifier: GPL-3.0-or-later
"""What `depsgraph.updates` says, by the keys of original data-blocks.

| edit | what Blender reports |
|---|---|
| object moved | the object, transform |
| mesh edited, modifier changed | the object, geometry (and its mesh) |
| material value or link | the material, shading; the group's node tree too |
| lamp | the lamp, and its object |
| world | the world |
| added, deleted, hidden | the scene only: the list of instances has to be compared |
"""

import bpy

from .. import compat


class Changes:
    """Keys of changed data-blocks since the last pass. `everything` overrides all of them."""

    def __init__(self, everything=False):
        self.everything = everything
        self.geometry = set()
        self.materials = set()
        self.images = set()
        self.all_materials = everything
        self.world = everything

    @classmethod
    def read(cls, depsgraph):
        """Collect the updates of a dependency graph."""
        changes = cls()
        for update in depsgraph.updates:
            data = update.id
            key = compat.stable_key(data)
            if isinstance(data, bpy.types.Object):
                if update.is_updated_geometry:
                    changes.geometry.add(key)
                # Assigning a material to an object's slot shows as shading of the object; the list
                # of instances is read anew anyway.
            elif isinstance(data, bpy.types.Material):
                changes.materials.add(key)
            elif isinstance(data, bpy.types.World):
                changes.world = True
            elif isinstance(data, bpy.types.Image):
                changes.images.add(key)
                changes.all_materials = changes.world = True
            elif isinstance(data, bpy.types.NodeTree):
                # A group may be used anywhere; an embedded tree is reported with its owner as well.
                changes.all_materials = changes.world = True
            elif isinstance(data, (bpy.types.Scene, bpy.types.Collection, bpy.types.Light)):
                pass
            elif update.is_updated_geometry:
                changes.geometry.add(key)
        return changes

    def touches_geometry(self, keys):
        """Tell whether any of these keys had its geometry changed."""
        return self.everything or not self.geometry.isdisjoint(keys)

    def touches_material(self, key):
        """Tell whether the material of this key has to be compiled again."""
        return self.everything or self.all_materials or key in self.materials
