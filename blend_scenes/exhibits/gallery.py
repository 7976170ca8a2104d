# SPDX-License-Identifier: GPL-3.0-or-later
"""The floor, the plinths and what all rows of exhibits share."""

import bpy

# Metres between plinths of a row, and between rows.
SPACING, ROW_DEPTH = 1.15, 1.75
PLINTH_RADIUS, PLINTH_HEIGHT = 0.42, 0.3
COLUMNS = 14


def link(made, collection=None):
    """Puts an object into a collection, the scene's own if none is named; returns it."""
    (collection or bpy.context.scene.collection).objects.link(made)
    return made


def thing(name, data, location, **settings):
    """An object of some data in the scene's collection."""
    made = bpy.data.objects.new(name, data)
    made.location = location
    for key, value in settings.items():
        setattr(made, key, value)
    return link(made)


def operator_object(name, location, operator, **settings):
    """The object that an operator of Blender's adds."""
    operator(location=location, **settings)
    made = bpy.context.object
    made.name = made.data.name = name
    return made


def plain(name, color, roughness=0.6, metallic=0.0):
    """A Principled material without textures."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    node = made.node_tree.nodes["Principled BSDF"]
    node.inputs["Base Color"].default_value = (*color, 1.0)
    node.inputs["Roughness"].default_value = roughness
    node.inputs["Metallic"].default_value = metallic
    made.diffuse_color = (*color, 1.0)
    return made


class Row:
    """Gives each exhibit of a row its plinth; `place` returns the middle of the plinth's top."""

    _plinth = None

    def __init__(self, title, number, material):
        self._number, self._column = number, 0
        self._material = material
        letters = bpy.data.curves.new(title, "FONT")
        letters.body, letters.size, letters.extrude, letters.align_x = title, 0.34, 0.02, "RIGHT"
        letters.materials.append(material)
        thing("title " + title, letters, (-0.5 * (COLUMNS + 0.2) * SPACING, self.y, 0.0), rotation_euler=(0.7, 0.0, 0.0))

    @property
    def y(self):
        """Where the row stands."""
        return self._number * ROW_DEPTH

    def place(self):
        """Adds a plinth."""
        if self._column == COLUMNS:
            raise IndexError("the row is full")
        x = (self._column - 0.5 * (COLUMNS - 1)) * SPACING
        self._column += 1
        if Row._plinth is None:
            bpy.ops.mesh.primitive_cylinder_add(vertices=32, radius=PLINTH_RADIUS, depth=PLINTH_HEIGHT)
            made = bpy.context.object
            Row._plinth = made.data
            made.data.name = "plinth"
            made.data.materials.append(self._material)
            bpy.data.objects.remove(made)
        thing("plinth", Row._plinth, (x, self.y, 0.5 * PLINTH_HEIGHT))
        return (x, self.y, PLINTH_HEIGHT)


def above(place, height):
    """The point this high above a plinth's top."""
    return (place[0], place[1], place[2] + height)
