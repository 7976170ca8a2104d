# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes atrium.blend beside this script: a vaulted gallery along a sunlit courtyard.

    blender -b --factory-startup -P blend_scenes/make_atrium.py

The sun reaches the gallery only through the arches, so what the camera sees is lit mostly by light that
bounced: warm from the tiles, green from the lawn, blue from the sky. One of each thing that a renderer
must get right is in it: instances, smooth and sharp surfaces, a tile floor with a normal map, a wooden
screen and leaves with alpha, metal, a glossy vase, an emissive lamp and a spot light. Everything,
images included, is computed here; the same script makes the same scene.
"""

import math
import random
import sys
from pathlib import Path

import bpy

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import shapes  # noqa: E402
import textures  # noqa: E402

HALF_WIDTH, SPRING, BAY, BAYS = 2.5, 3.5, 2.8, 5
LENGTH = BAY * BAYS
WALL = 0.45
DOOR_WIDTH, DOOR_SPRING = 1.9, 2.15
COURT_WIDTH = 8.0

# Principled sockets by their names before and since Blender 4.0.
RENAMED = {"Specular": "Specular IOR Level", "Emission": "Emission Color"}


def set_input(node, name, value):
    """Sets a socket under whichever of its names this Blender knows."""
    socket = node.inputs.get(name) or node.inputs[RENAMED[name]]
    socket.default_value = (*value, 1.0) if isinstance(value, tuple) else value


def material(name, colour=(0.8, 0.8, 0.8), **inputs):
    """A Principled material; inputs by Blender 3.4's socket names, with _ for spaces. Returns it and its node."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    node = made.node_tree.nodes["Principled BSDF"]
    set_input(node, "Base Color", colour)
    for key, value in inputs.items():
        set_input(node, key.replace("_", " "), value)
    return made, node


def texture_node(made, image, **settings):
    """An Image Texture node in a material."""
    node = made.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    for key, value in settings.items():
        setattr(node, key, value)
    return node


def plastered(name, one, other, blotches):
    """Two colours mixed by an image, as lime plaster is never of one colour."""
    made, principled = material(name, Roughness=0.9, Specular=0.2)
    mix = made.node_tree.nodes.new("ShaderNodeMix")
    mix.data_type = "RGBA"
    # The node has a socket of each name for every type of value; these are the factor and the colours.
    mix.inputs[6].default_value, mix.inputs[7].default_value = (*one, 1.0), (*other, 1.0)
    made.node_tree.links.new(texture_node(made, blotches).outputs["Color"], mix.inputs[0])
    made.node_tree.links.new(mix.outputs[2], principled.inputs["Base Color"])
    return made


def cut_out(name, image, **inputs):
    """A material whose colour and alpha come from one image."""
    made, principled = material(name, **inputs)
    picture = texture_node(made, image, extension="CLIP" if name == "leaf" else "REPEAT")
    made.node_tree.links.new(picture.outputs["Color"], principled.inputs["Base Color"])
    made.node_tree.links.new(picture.outputs["Alpha"], principled.inputs["Alpha"])
    # What the viewport's own engine shows; Cycles and Panoptes follow the nodes.
    if hasattr(made, "blend_method"):
        made.blend_method = "HASHED"
    return made


def tiled_floor():
    """Terracotta tiles with a normal map."""
    made, principled = material("tiles", Roughness=0.45)
    links = made.node_tree.links
    links.new(texture_node(made, textures.packed("tiles", textures.tiles())).outputs["Color"], principled.inputs["Base Color"])
    bumps = textures.packed("tiles normal", textures.normals(textures.tile_height(256), 6.0), data=True)
    normal = made.node_tree.nodes.new("ShaderNodeNormalMap")
    normal.uv_map = "UVMap"
    links.new(texture_node(made, bumps).outputs["Color"], normal.inputs["Color"])
    links.new(normal.outputs["Normal"], principled.inputs["Normal"])
    return made


def plane(name, made, low, high, z=0.0, scale=1.0, face_down=False):
    """A horizontal rectangle from (x, y) low to high; UVs in metres times scale."""
    shape = shapes.Shape()
    corners = [(low[0], low[1], z), (high[0], low[1], z), (high[0], high[1], z), (low[0], high[1], z)]
    corners = corners[::-1] if face_down else corners
    shape.face(corners, [(x * scale, y * scale) for x, y, _ in corners])
    return shape.object(name, made)


def build_gallery(stone, ochre, coral):
    """Walls, arches, vault and columns."""
    doors = [BAY * (bay + 0.5) for bay in range(BAYS)]
    piers = [BAY * bay for bay in range(1, BAYS)]
    shapes.arched_wall(LENGTH, SPRING + 0.02, doors, DOOR_WIDTH, DOOR_SPRING, WALL).object("arcade", stone, (HALF_WIDTH, 0, 0))

    wall = shapes.Shape()
    wall.face([(-HALF_WIDTH, 0, 0), (-HALF_WIDTH, LENGTH, 0), (-HALF_WIDTH, LENGTH, SPRING), (-HALF_WIDTH, 0, SPRING)][::-1],
              [(0, 0), (LENGTH, 0), (LENGTH, SPRING), (0, SPRING)][::-1])
    wall.object("long wall", ochre)
    shapes.gable(HALF_WIDTH, SPRING, 4.35, 0.75).object("end wall", coral, (0, LENGTH, 0))
    near = shapes.gable(HALF_WIDTH, SPRING, 4.35, 0.02).object("near wall", ochre, (0, 0, 0))
    near.rotation_euler = (0, 0, math.pi)
    shapes.vault(HALF_WIDTH, SPRING, LENGTH, piers).object("vault", stone)

    trim = shapes.Shape()
    for side in (-1, 1):
        low, high = sorted((side * HALF_WIDTH, side * (HALF_WIDTH - 0.12)))
        trim.box((low, 0.0, SPRING - 0.09), (high, LENGTH, SPRING + 0.06))
    trim.box((-HALF_WIDTH, 0.0, 0.0), (-HALF_WIDTH + 0.05, LENGTH, 0.22))
    trim.object("cornice", stone)

    profile = [(0.0, 0.0), (0.24, 0.0), (0.24, 0.0), (0.24, 0.12), (0.24, 0.12), (0.2, 0.14), (0.215, 0.18), (0.2, 0.22), (0.165, 0.26),
               (0.17, 0.6), (0.172, 1.2), (0.16, 2.2), (0.145, 3.0), (0.145, 3.0), (0.175, 3.03), (0.145, 3.06), (0.145, 3.1), (0.18, 3.2),
               (0.25, 3.32), (0.25, 3.32), (0.25, SPRING - 0.09)]
    first = shapes.lathe(profile, 28).object("column", stone, (HALF_WIDTH - 0.27, piers[0], 0))
    for index, y in enumerate(piers):
        if index:
            shapes.instance(f"column right {index}", first.data, (HALF_WIDTH - 0.27, y, 0))
        shapes.instance(f"column left {index}", first.data, (-HALF_WIDTH + 0.27, y, 0))


def build_court(stone, ochre):
    """Lawn, path and walls outside, which send the sunlight in."""
    lawn, _ = material("lawn", (0.13, 0.26, 0.05), Roughness=1.0, Specular=0.1)
    outer = HALF_WIDTH + WALL
    plane("lawn", lawn, (outer + 1.2, -3.0), (outer + COURT_WIDTH, LENGTH + 3.0), -0.02)
    plane("path", stone, (outer - 0.5, -3.0), (outer + 1.2, LENGTH + 3.0), -0.01)
    walls = shapes.Shape()
    walls.box((outer + COURT_WIDTH, -3.2, -0.1), (outer + COURT_WIDTH + 0.3, LENGTH + 3.2, 2.6))
    walls.box((outer, LENGTH + 3.0, -0.1), (outer + COURT_WIDTH, LENGTH + 3.3, 4.4))
    walls.object("court walls", ochre)
    # A roof over the vault, or its thin shell would be all that stands between the sky and the gallery.
    plane("roof", stone, (-HALF_WIDTH - 0.3, -0.3), (outer + 0.35, LENGTH + 0.3), SPRING + HALF_WIDTH + 0.25, face_down=True)


def build_things(stone):
    """What stands and hangs in the gallery."""
    cloth, _ = material("velvet", (0.02, 0.13, 0.17), Roughness=0.85, Specular=0.3)
    drape = shapes.curtain(2.0, 2.9, 8, 0.075)
    first = drape.object("curtain", cloth, (-HALF_WIDTH + 0.16, 1.5 * BAY - 1.0, 0.08))
    shapes.instance("curtain far", first.data, (-HALF_WIDTH + 0.16, 3.5 * BAY - 1.0, 0.08))
    brass, _ = material("brass", (0.83, 0.58, 0.25), Metallic=1.0, Roughness=0.28)
    rods = shapes.Shape()
    for bay in (1, 3):
        rods.box((-HALF_WIDTH + 0.13, (bay + 0.5) * BAY - 1.12, 2.97), (-HALF_WIDTH + 0.17, (bay + 0.5) * BAY + 1.12, 3.01))
    rods.object("rods", brass)

    # The vase on its plinth, at the end of the axis.
    plinth = shapes.Shape()
    plinth.box((-0.36, -0.36, 0.0), (0.36, 0.36, 0.1))
    plinth.box((-0.29, -0.29, 0.1), (0.29, 0.29, 0.92))
    plinth.box((-0.35, -0.35, 0.92), (0.35, 0.35, 1.0))
    block = plinth.object("plinth", stone, (0.0, LENGTH - 1.6, 0.0))
    glaze, _ = material("glaze", (0.75, 0.77, 0.72), Roughness=0.12)
    body = [(0.0, 0.0), (0.13, 0.0), (0.13, 0.0), (0.15, 0.03), (0.11, 0.07), (0.1, 0.1), (0.17, 0.2), (0.27, 0.36), (0.31, 0.52), (0.28, 0.68),
            (0.19, 0.8), (0.12, 0.88), (0.105, 0.98), (0.12, 1.06), (0.17, 1.12), (0.17, 1.12), (0.15, 1.12), (0.1, 1.05), (0.085, 0.95)]
    shapes.lathe(body, 48).object("vase", glaze, (0.0, LENGTH - 1.6, 1.0))
    # A second plinth carries a sphere of brass.
    shapes.instance("plinth near", block.data, (1.35, 2.0 * BAY + 0.1, 0.0), math.radians(8.0), 0.8)
    ball = [(max(0.0, 0.3 * math.sin(math.pi * s / 24)), -0.3 * math.cos(math.pi * s / 24)) for s in range(25)]
    shapes.lathe(ball, 48).object("sphere", brass, (1.35, 2.0 * BAY + 0.1, 1.1))

    wood = cut_out("screen", textures.packed("screen", textures.lattice()), Roughness=0.6, Specular=0.3)
    screen = shapes.Shape()
    high = DOOR_SPRING + DOOR_WIDTH / 2.0 + 0.05
    wide = DOOR_WIDTH / 2.0 + 0.05
    screen.face([(0, wide, 0), (0, -wide, 0), (0, -wide, high), (0, wide, high)], [(0, 0), (1.2, 0), (1.2, 1.9), (0, 1.9)])
    leaf = screen.object("screen", wood, (HALF_WIDTH + WALL + 0.01, 1.5 * BAY, 0.0))
    shapes.instance("screen far", leaf.data, (HALF_WIDTH + WALL + 0.01, 3.5 * BAY, 0.0))

    build_plant((-1.62, 4.65, 0.0), 1.0, 3)
    build_plant((1.75, 9.7, 0.0), 0.85, 5)
    build_lantern((-0.35, 5.6, 3.6), brass)


def build_plant(location, size, seed):
    """A potted plant of leaf cards that share one mesh."""
    clay = bpy.data.materials.get("clay") or material("clay", (0.42, 0.17, 0.09), Roughness=0.75)[0]
    pot = [(0.0, 0.0), (0.17, 0.0), (0.17, 0.0), (0.24, 0.38), (0.24, 0.38), (0.27, 0.38), (0.27, 0.38), (0.28, 0.46), (0.28, 0.46), (0.24, 0.46),
           (0.24, 0.46), (0.23, 0.4), (0.0, 0.4)]
    shapes.lathe(pot, 32).object("pot", clay, location).scale = (size, size, size)
    green = bpy.data.materials.get("leaf") or cut_out("leaf", textures.packed("leaf", textures.leaf()), Roughness=0.4)
    mesh = bpy.data.meshes.get("leaf")
    dice = random.Random(seed)
    for index in range(34):
        turn, scale = 2.399963 * index + dice.uniform(-0.2, 0.2), size * dice.uniform(0.75, 1.15)
        base = (location[0] + 0.06 * math.cos(turn), location[1] + 0.06 * math.sin(turn), location[2] + 0.4 * size)
        made = (shapes.instance("leaf", mesh, base, turn, scale) if mesh
                else shapes.leaf_card(0.95, 0.24, 1.25, 1.9).object("leaf", green, base))
        mesh = made.data
        # Inner leaves stand, outer ones bow.
        made.rotation_euler = (dice.uniform(-0.25, 0.25), -0.75 + 1.15 * (index / 34.0) ** 0.8 + dice.uniform(-0.1, 0.1), turn)
        made.scale = (scale, scale, scale)


def build_lantern(location, brass):
    """A hanging globe that glows, and its chain."""
    glow, node = material("glow", (0.0, 0.0, 0.0), Specular=0.0)
    set_input(node, "Emission", (1.0, 0.62, 0.28))
    node.inputs["Emission Strength"].default_value = 14.0
    globe = [(max(0.0, 0.14 * math.sin(math.pi * s / 16)), -0.14 * math.cos(math.pi * s / 16)) for s in range(17)]
    shapes.lathe(globe, 32).object("globe", glow, location)
    chain = shapes.Shape()
    chain.box((-0.012, -0.012, 0.12), (0.012, 0.012, SPRING + HALF_WIDTH - location[2]))
    chain.object("chain", brass, location)
    cap = [(0.0, 0.115), (0.1, 0.115), (0.1, 0.115), (0.06, 0.19), (0.0, 0.2)]
    shapes.lathe(cap, 24).object("cap", brass, location)


def build_light():
    """Sun, sky, the vase's spot light and the camera."""
    def lamp(name, kind, energy, colour, location, target=None, rotation=None, **settings):
        light = bpy.data.lights.new(name, kind)
        light.energy, light.color = energy, colour
        for key, value in settings.items():
            setattr(light, key, value)
        made = bpy.data.objects.new(name, light)
        made.location = location
        bpy.context.scene.collection.objects.link(made)
        aim(made, target)
        return made

    def aim(made, target):
        from mathutils import Vector
        made.rotation_euler = (Vector(target) - made.location).to_track_quat("-Z", "Y").to_euler()

    lamp("sun", "SUN", 14.0, (1.0, 0.86, 0.68), (20.0, -2.0, 13.8), (0.0, 4.5, 0.0), angle=math.radians(0.53))
    lamp("vase spot", "SPOT", 160.0, (1.0, 0.9, 0.75), (-1.3, LENGTH - 4.4, 4.6), (0.0, LENGTH - 1.6, 1.4), spot_size=math.radians(38.0),
         spot_blend=0.5, shadow_soft_size=0.05)

    world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (0.36, 0.56, 1.0, 1.0)
    background.inputs["Strength"].default_value = 1.1
    bpy.context.scene.world = world

    camera = bpy.data.cameras.new("camera")
    camera.lens = 23.0
    made = bpy.data.objects.new("camera", camera)
    made.location = (-0.95, 0.55, 1.62)
    bpy.context.scene.collection.objects.link(made)
    aim(made, (0.2, 8.0, 2.05))
    bpy.context.scene.camera = made


def main():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    blotches = textures.packed("blotches", textures.plaster(), data=True)
    stone = plastered("limestone", (0.62, 0.55, 0.45), (0.74, 0.68, 0.58), blotches)
    ochre = plastered("ochre plaster", (0.66, 0.42, 0.17), (0.76, 0.53, 0.26), blotches)
    coral = plastered("coral plaster", (0.58, 0.17, 0.11), (0.67, 0.25, 0.16), blotches)
    floor = tiled_floor()
    plane("floor", floor, (-HALF_WIDTH, 0.0), (HALF_WIDTH + WALL, LENGTH), scale=0.5)
    build_gallery(stone, ochre, coral)
    build_court(stone, ochre)
    build_things(stone)
    build_light()

    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 960, 540, 100
    scene.render.image_settings.file_format = "PNG"
    scene.view_settings.view_transform = "Filmic"
    scene.view_settings.exposure = 0.8
    if hasattr(scene, "cycles"):
        scene.render.engine = "CYCLES"
        scene.cycles.samples, scene.cycles.seed = 256, 1
        # Debian's Blender has no denoiser and refuses to render where one is asked for.
        scene.cycles.use_denoising = False
    bpy.ops.wm.save_as_mainfile(filepath=str(HERE / "atrium.blend"), compress=True)


main()
