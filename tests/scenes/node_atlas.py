# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds one picture of many materials, each in a tile of its own; runs inside Blender.

The camera looks straight down at a grid of tiles, one material a tile. Values shine by themselves from a flat quad, so
that both engines show the same number without any light; closures lie on a curved patch, seen and lit from many
directions, under the lamps or the world of their group. node_cases.py says what the tiles show.
"""

import math
import random

import bpy
import numpy as np
from mathutils import Matrix

import node_cases

# What a value becomes before it shines: negative light is not shown, and a tile may be anywhere in -19..
SCALE, OFFSET = node_cases.SCALE, node_cases.OFFSET


class Tree:
    """A material's nodes, built in a few words."""

    def __init__(self, material, name):
        self.material = material
        self.nodes, self.links = material.node_tree.nodes, material.node_tree.links
        self.random = random.Random(name)

    def add(self, kind, **settings):
        """A node by its name without ShaderNode; settings are its properties."""
        node = self.nodes.new("ShaderNode" + kind)
        for name, value in settings.items():
            setattr(node, name, value)
        return node

    def link(self, source, target):
        """Links an output socket to an input socket."""
        self.links.new(source, target)

    def place(self, low, high, turn=0):
        """A vector socket whose components run over low..high across the tile, differently for each `turn`."""
        split, joined = self.add("SeparateXYZ"), self.add("CombineXYZ")
        product, moved = self.add("Math", operation="MULTIPLY"), self.add("VectorMath", operation="MULTIPLY_ADD")
        self.link(self.add("UVMap").outputs[0], split.inputs[0])
        u, v = split.outputs[0], split.outputs[1]
        self.link(u, product.inputs[0])
        self.link(v, product.inputs[1])
        parts = [u, v, product.outputs[0]]
        for index, socket in enumerate(parts[turn:] + parts[:turn]):
            self.link(socket, joined.inputs[index])
        self.link(joined.outputs[0], moved.inputs[0])
        moved.inputs[1].default_value = [high - low] * 3
        moved.inputs[2].default_value = [low] * 3
        return moved.outputs[0]

    def component(self, vector, index):
        """One component of a vector socket."""
        split = self.add("SeparateXYZ")
        self.link(vector, split.inputs[0])
        return split.outputs[index]

    def vary(self, node, low, high):
        """Gives every input that is not linked a value: the first two differ across the tile, the others are constants."""
        turn = 0
        for socket in node.inputs:
            if socket.is_linked or not socket.enabled or not hasattr(socket, "default_value"):
                continue
            if turn < 2 and socket.type in ("VALUE", "VECTOR", "RGBA"):
                # Not quite alike, so that nothing hangs on whether two inputs are equal.
                vector = self.place(low, high - 0.07 * turn * (high - low), turn)
                self.link(self.component(vector, turn) if socket.type == "VALUE" else vector, socket)
                turn += 1
            elif socket.type == "VALUE":
                socket.default_value = self.random.uniform(low, high)
            elif socket.type == "VECTOR":
                socket.default_value = [self.random.uniform(low, high) for _ in range(3)]
            elif socket.type == "RGBA":
                socket.default_value = [self.random.uniform(max(low, 0.0), high) for _ in range(3)] + [1.0]

    def image(self, pixels, name="picture", colorspace="sRGB", floats=False):
        """A packed picture of float[H, W, 4], row 0 at the bottom."""
        made = bpy.data.images.new(name, pixels.shape[1], pixels.shape[0], alpha=True, float_buffer=floats)
        made.colorspace_settings.name = colorspace
        made.pixels.foreach_set(np.ascontiguousarray(pixels, np.float32).ravel())
        made.update()
        made.pack()
        return made


def value_material(case):
    """A material that shines with the case's value."""
    material, tree, output = empty_material(case)
    shown = case.build(tree)
    scaled, shine = tree.add("VectorMath", operation="MULTIPLY_ADD"), tree.add("Emission")
    scaled.inputs[1].default_value, scaled.inputs[2].default_value = [SCALE] * 3, [OFFSET] * 3
    tree.link(shown, scaled.inputs[0])
    tree.link(scaled.outputs[0], shine.inputs["Color"])
    tree.link(shine.outputs[0], output.inputs["Surface"])
    return material


def closure_material(case):
    """A material whose surface is the case's shader."""
    material, tree, output = empty_material(case)
    shown = case.build(tree)
    if shown is not None:
        tree.link(shown, output.inputs["Surface"])
    return material


def empty_material(case):
    """A material of an output node alone: (material, Tree, output)."""
    material = bpy.data.materials.new(case.name)
    material.use_nodes = True
    material.node_tree.nodes.clear()
    tree = Tree(material, case.name)
    return material, tree, tree.add("OutputMaterial")


def quad():
    """A unit square facing +z of four triangles, none of whose edges meets a pixel's centre; UVs 0..1."""
    mesh = bpy.data.meshes.new("quad")
    points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.53, 0.48, 0)]
    mesh.from_pydata(points, [], [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)])
    map_from_above(mesh)
    return mesh


def map_from_above(mesh):
    """Gives the mesh its x and y as UV map."""
    corners = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    places = np.empty(len(mesh.vertices) * 3, np.float32)
    mesh.vertices.foreach_get("co", places)
    mesh.uv_layers.new(name="UVMap").data.foreach_set("uv", places.reshape(-1, 3)[corners, :2].ravel())


def patch(cells=23):
    """The top of a sphere over the unit square, smooth, whose rim is 70 degrees steep; UVs 0..1."""
    mesh, side = bpy.data.meshes.new("patch"), cells + 1
    u, v = np.meshgrid(np.linspace(0, 1, side), np.linspace(0, 1, side))
    radius = math.sqrt(0.5) / math.sin(math.radians(70))
    height = np.sqrt(radius**2 - (u - 0.5) ** 2 - (v - 0.5) ** 2) - radius
    points = np.stack([u, v, height], axis=-1).reshape(-1, 3)
    faces = [(row * side + column, row * side + column + 1, (row + 1) * side + column + 1, (row + 1) * side + column)
             for row in range(cells) for column in range(cells)]
    mesh.from_pydata(points.tolist(), [], faces)
    mesh.polygons.foreach_set("use_smooth", [True] * len(faces))
    map_from_above(mesh)
    return mesh


def build(group):
    """Empties the file and builds the tiles of a group of node_cases.py."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    light, cases = node_cases.GROUPS[group], node_cases.cases(group)
    side = node_cases.side(len(cases))
    world = scene.world = bpy.data.worlds.new("world")
    world.use_nodes = True
    background = world.node_tree.nodes["Background"].inputs
    background["Color"].default_value = (*light.world, 1.0)
    background["Strength"].default_value = 1.0 if any(light.world) else 0.0
    for place, energy in light.suns:
        lamp = bpy.data.lights.new("sun", "SUN")
        lamp.energy, lamp.angle, lamp.use_shadow = energy, 0.0, False
        lamp.cycles.cast_shadow = False
        made = bpy.data.objects.new("sun", lamp)
        made.rotation_euler = place
        scene.collection.objects.link(made)
    mesh = patch() if light.curved else quad()
    mesh.materials.append(None)
    # What the mesh has less, every object has more: object space is not world space.
    turned = Matrix.Rotation(0.7, 4, (0.3, -0.5, 0.8)) @ Matrix.Diagonal((0.5, 2.0, 0.8, 1.0))
    mesh.transform(turned.inverted())
    for index, case in enumerate(cases):
        made = bpy.data.objects.new(case.name, mesh)
        made.matrix_world = Matrix.Translation((index % side, index // side, 0.0)) @ turned
        scene.collection.objects.link(made)
        # Neighbours must not stand in the world's light, nor be seen in each other.
        made.visible_shadow = made.visible_diffuse = made.visible_glossy = made.visible_transmission = False
        made.material_slots[0].link = "OBJECT"
        made.material_slots[0].material = (value_material if light.values else closure_material)(case)
    view = bpy.data.cameras.new("camera")
    view.type, view.ortho_scale, view.clip_end = "ORTHO", side, 100.0
    scene.camera = bpy.data.objects.new("camera", view)
    scene.camera.location = (side / 2, side / 2, 10.0)
    scene.collection.objects.link(scene.camera)
    scene.render.resolution_x = scene.render.resolution_y = side * node_cases.PIXELS
    scene.render.resolution_percentage = 100
    # Both engines look through the pixels' centres.
    scene.render.filter_size = scene.cycles.filter_width = 0.01
    scene.view_settings.view_transform = "Standard"
    scene.cycles.max_bounces = 1
    scene.cycles.use_denoising = False
    bpy.context.view_layer.update()
