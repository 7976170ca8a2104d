# SPDX-License-Identifier: GPL-3.0-or-later
"""Small scenes for tests, each built by one function into the emptied current file; runs inside Blender.

`build(name)` empties the file and builds; NAMES lists them. Every scene renders at 160x90 and has a black
world, so that what is seen is the lamps' light. Lamps have no size unless a function says otherwise: their
shadows are hard and their light needs no sampling.
"""

import math

import bmesh
import bpy
import numpy as np
from mathutils import Vector

# Principled sockets by their names before and since Blender 4.0.
RENAMED = {"Specular": "Specular IOR Level", "Emission": "Emission Color", "Transmission": "Transmission Weight"}


def principled(name="grey", color=(0.8, 0.8, 0.8), **inputs):
    """A Principled material; inputs by Blender 3.4's socket names, with _ for spaces. Returns it and its node."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    node = material.node_tree.nodes["Principled BSDF"]
    for key, value in {"Base Color": (*color, 1.0), **inputs}.items():
        key = key.replace("_", " ")
        (node.inputs.get(key) or node.inputs[RENAMED[key]]).default_value = value
    return material, node


def linked(name, data, location=(0, 0, 0), rotation=(0, 0, 0), scale=(1, 1, 1)):
    """An object of the data in the scene."""
    made = bpy.data.objects.new(name, data)
    made.location, made.rotation_euler, made.scale = location, rotation, scale
    bpy.context.scene.collection.objects.link(made)
    return made


def rectangle(name, material, size=(1.0, 1.0), **place):
    """A rectangle facing +z around its origin, UVs 0..1."""
    x, y = size[0] / 2.0, size[1] / 2.0
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([(-x, -y, 0), (x, -y, 0), (x, y, 0), (-x, y, 0)], [], [(0, 1, 2, 3)])
    mesh.uv_layers.new(name="UVMap").data.foreach_set("uv", [0, 0, 1, 0, 1, 1, 0, 1])
    mesh.materials.append(material)
    return linked(name, mesh, **place)


def solid(name, material, make, smooth=False, **place):
    """An object of what make(bmesh) builds."""
    mesh, work = bpy.data.meshes.new(name), bmesh.new()
    make(work)
    work.to_mesh(mesh)
    work.free()
    mesh.polygons.foreach_set("use_smooth", [smooth] * len(mesh.polygons))
    mesh.materials.append(material)
    return linked(name, mesh, **place)


def sphere(name, material, radius=1.0, smooth=True, segments=48, **place):
    """A sphere of latitudes and longitudes."""
    return solid(name, material, lambda work: bmesh.ops.create_uvsphere(
        work, u_segments=segments, v_segments=segments // 2, radius=radius), smooth, **place)


def cube(name, material, size=1.0, **place):
    """A cube around its origin."""
    return solid(name, material, lambda work: bmesh.ops.create_cube(work, size=size), **place)


def lamp(kind, energy, location=(0, 0, 3), target=(0, 0, 0), color=(1, 1, 1), **settings):
    """A lamp without size that looks at the target; settings override."""
    light = bpy.data.lights.new(kind.lower(), kind)
    light.energy, light.color = energy, color
    if kind in ("POINT", "SPOT"):
        light.shadow_soft_size = 0.0
    elif kind == "SUN":
        light.angle = 0.0
    else:
        # A disk, since Cycles loses precision on tiny squares (14 % of the light for 1 mm seen from 1 m).
        light.shape, light.size = "DISK", 0.001
    for key, value in settings.items():
        setattr(light, key, value)
    made = linked(kind.lower(), light, location)
    made.rotation_euler = (Vector(target) - Vector(location)).to_track_quat("-Z", "Y").to_euler()
    return made


def camera(location=(0.0, -6.0, 3.2), target=(0.0, 0.0, 0.5), **settings):
    """The scene's camera, looking at the target."""
    data = bpy.data.cameras.new("camera")
    for key, value in settings.items():
        setattr(data, key, value)
    made = linked("camera", data, location)
    made.rotation_euler = (Vector(target) - Vector(location)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.camera = made
    return made


def stage():
    """A floor, a back wall, a box, a smooth and a faceted sphere, under the usual camera."""
    rectangle("floor", principled("floor", (0.7, 0.65, 0.6), Roughness=0.8)[0], (12, 12))
    rectangle("wall", principled("wall", (0.4, 0.5, 0.7))[0], (12, 6), location=(0, 4, 3), rotation=(math.pi / 2, 0, 0))
    cube("box", principled("red", (0.8, 0.15, 0.1))[0], location=(-1.6, 0.2, 0.5), rotation=(0, 0, 0.5))
    sphere("smooth", principled("green", (0.15, 0.6, 0.2), Roughness=0.3)[0], 0.7, location=(0.2, 0.4, 0.7))
    sphere("facets", principled("white", (0.9, 0.9, 0.9), Roughness=1.0)[0], 0.6, False, 10, location=(1.8, -0.3, 0.6))
    camera()


# --- the scenes -----------------------------------------------------------------------------------------


def sun():
    """A sun over a few objects."""
    stage()
    lamp("SUN", 3.0, (3, -2, 5), color=(1.0, 0.9, 0.8))


def point():
    """A point lamp between a few objects."""
    stage()
    lamp("POINT", 300.0, (0.9, -1.5, 2.5), color=(0.8, 0.9, 1.0))


def spot():
    """A spot lamp whose cone ends on the floor, with a soft rim."""
    stage()
    lamp("SPOT", 800.0, (-1.5, -2.5, 4.0), (0.2, 0.2, 0.3), spot_size=math.radians(50), spot_blend=0.4)


def area():
    """An area lamp, small as a point, over a few objects."""
    stage()
    lamp("AREA", 150.0, (1.0, -2.0, 3.5), (0, 0.3, 0.3))


def four_lamps():
    """All four types of lamp in different colours."""
    stage()
    lamp("SUN", 0.8, (3, -2, 5), color=(1.0, 0.6, 0.3))
    lamp("POINT", 120.0, (0.9, -1.8, 2.5), color=(0.3, 1.0, 0.4))
    lamp("SPOT", 500.0, (-2.5, -2.0, 4.0), (0.2, 0.2, 0.3), color=(0.3, 0.4, 1.0), spot_size=math.radians(60), spot_blend=0.2)
    lamp("AREA", 60.0, (2.5, -1.0, 3.0), (0.5, 0.5, 0.3), color=(1.0, 0.3, 0.9))


def soft_lamps():
    """All four types with sizes: penumbrae."""
    four_lamps()
    for made in bpy.context.scene.objects:
        if made.type == "LIGHT" and made.data.type == "SUN":
            made.data.angle = math.radians(5)
        elif made.type == "LIGHT" and made.data.type == "AREA":
            made.data.shape, made.data.size, made.data.size_y = "RECTANGLE", 1.2, 0.6
        elif made.type == "LIGHT":
            made.data.shadow_soft_size = 0.25


def glow():
    """Nothing but glowing surfaces: a plate of two colours, a warm bulb, a cold tilted box."""
    stage()
    split = np.ones((8, 16, 4), np.float32)
    split[:, :8, :3], split[:, 8:, :3] = (1.0, 0.2, 0.1), (0.1, 0.4, 1.0)
    plate, node = principled("plate", (0, 0, 0), Emission_Strength=6.0)
    plate.node_tree.links.new(image_node(plate, image("split", split)).outputs["Color"],
                              node.inputs.get("Emission") or node.inputs["Emission Color"])
    rectangle("plate", plate, (2.0, 1.0), location=(0.5, 1.0, 3.2), rotation=(math.pi - 0.3, 0, 0))
    bulb = principled("bulb", (0, 0, 0), Emission=(1.0, 0.7, 0.4, 1.0), Emission_Strength=60.0)[0]
    sphere("bulb", bulb, 0.15, segments=24, location=(-2.6, -1.2, 1.4))
    box = principled("box", (0, 0, 0), Emission=(0.5, 0.7, 1.0, 1.0), Emission_Strength=8.0)[0]
    cube("tube", box, 0.4, location=(2.8, 0.6, 1.6), rotation=(0.3, 0.2, 0.5))


def shader(name, kind, **inputs):
    """A material of one shader node; inputs by their names, with _ for spaces."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    node = tree.nodes.new(kind)
    for key, value in inputs.items():
        node.inputs[key.replace("_", " ")].default_value = value
    tree.links.new(node.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    return material


def mirrors():
    """A mirror, a glass ball, a pane and a rough metal ball before lit walls; light bounces off no rough surface."""
    for index, (color, place) in enumerate([((0.7, 0.65, 0.6), {}), ((0.2, 0.5, 0.8), {"location": (-4, 0, 3), "rotation": (0, math.pi / 2, 0)}),
                                            ((0.8, 0.3, 0.2), {"location": (0, -5, 3), "rotation": (-math.pi / 2, 0, 0)})]):
        rectangle(f"wall {index}", shader(f"wall {index}", "ShaderNodeBsdfDiffuse", Color=(*color, 1.0)), (12, 12), **place)
    rectangle("mirror", shader("mirror", "ShaderNodeBsdfGlossy", Color=(0.9, 0.8, 0.7, 1.0), Roughness=0.0), (7, 4),
              location=(0.5, 3, 1.6), rotation=(math.pi / 2, 0, 0.2))
    sphere("glass", shader("glass", "ShaderNodeBsdfGlass", Roughness=0.0, IOR=1.45), 0.8, segments=96, location=(-1.2, 0, 0.9))
    sphere("metal", shader("metal", "ShaderNodeBsdfGlossy", Color=(1.0, 0.8, 0.4, 1.0), Roughness=0.25), 0.8, segments=96,
           location=(1.2, 0.3, 0.9))
    cube("pane", shader("pane", "ShaderNodeBsdfGlass", Roughness=0.0, IOR=1.2), location=(0.2, -1.6, 0.6), scale=(0.9, 0.1, 1.0))
    camera((0.0, -4.5, 2.0), (0.0, 0.0, 0.9))
    lamp("POINT", 600.0, (1.5, -2.5, 4.0), color=(1.0, 0.9, 0.8))
    cycles = bpy.context.scene.cycles
    cycles.max_bounces, cycles.diffuse_bounces, cycles.glossy_bounces, cycles.transmission_bounces = 12, 0, 8, 12


def alpha_card():
    """A card with round holes cut by a texture's alpha, and one of plain alpha .5, both casting shadows."""
    rectangle("floor", principled("floor", (0.7, 0.7, 0.7))[0], (12, 12))
    x, y = np.meshgrid((np.arange(64) + 0.5) / 64, (np.arange(64) + 0.5) / 64)
    holes = np.hypot(x * 4 % 1 - 0.5, y * 4 % 1 - 0.5)
    pixels = np.stack([0.2 + 0.6 * x, 0.5 + 0 * x, 0.8 - 0.6 * y, np.clip((holes - 0.3) * 16 + 0.5, 0, 1)], axis=-1)
    material, node = principled("card")
    picture = image_node(material, image("holes", pixels))
    material.node_tree.links.new(picture.outputs["Color"], node.inputs["Base Color"])
    material.node_tree.links.new(picture.outputs["Alpha"], node.inputs["Alpha"])
    rectangle("card", material, (2, 2), location=(-1.2, 0.5, 1.1), rotation=(math.radians(70), 0, 0.3))
    rectangle("veil", principled("veil", (0.9, 0.5, 0.2), Alpha=0.5)[0], (1.6, 1.6), location=(1.3, 0.3, 1.0),
              rotation=(math.radians(65), 0, -0.4))
    camera()
    lamp("SUN", 3.0, (1.5, -3, 5))


def normal_map():
    """A floor and a sphere with a normal map of round bumps, lit at a slant."""
    size = 128
    place = (np.arange(size) + 0.5) / size * 4 % 1 - 0.5
    x, y = np.meshgrid(place, place)
    slope = np.where(np.hypot(x, y) < 0.4, 1.6, 0.0)
    normal = np.stack([slope * x, slope * y, np.ones_like(x)], axis=-1)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    pixels = np.concatenate([normal * 0.5 + 0.5, np.ones((size, size, 1))], axis=-1)
    material, node = principled("bumps", (0.7, 0.7, 0.7))
    bumps = material.node_tree.nodes.new("ShaderNodeNormalMap")
    bumps.uv_map = "UVMap"
    material.node_tree.links.new(image_node(material, image("bumps", pixels, data=True)).outputs["Color"], bumps.inputs["Color"])
    material.node_tree.links.new(bumps.outputs["Normal"], node.inputs["Normal"])
    rectangle("floor", material, (4, 4))
    ball = sphere("ball", material, 0.8, location=(0, 0.5, 0.8))
    layer = ball.data.uv_layers.new(name="UVMap")
    corners = np.empty(len(ball.data.loops), np.int32)
    ball.data.loops.foreach_get("vertex_index", corners)
    vertices = np.empty((len(ball.data.vertices), 3), np.float32)
    ball.data.vertices.foreach_get("co", vertices.ravel())
    layer.data.foreach_set("uv", (vertices[corners][:, [0, 2]] * 0.6).ravel())
    camera()
    lamp("SUN", 3.0, (4, -2, 3))


def instances():
    """Twelve instances of one mesh: linked objects, mirrored, scaled unevenly, and a collection instance."""
    rectangle("floor", principled("floor", (0.6, 0.6, 0.6))[0], (12, 12))
    first = solid("cone", principled("blue", (0.2, 0.4, 0.8))[0], lambda work: bmesh.ops.create_cone(
        work, cap_ends=True, segments=24, radius1=0.4, radius2=0.1, depth=1.0), location=(-2.5, 0, 0.5))
    for index in range(1, 10):
        linked(f"cone {index}", first.data, (-2.5 + 0.55 * index, 0.8 * math.sin(index), 0.5), (0, 0.1 * index, 0.3 * index),
               (-1.0 if index % 3 == 0 else 1.0, 1.0, 1.0 + 0.15 * index))
    group = bpy.data.collections.new("group")
    group.objects.link(bpy.data.objects.new("inner", first.data))
    for x in (-1.0, 1.0):
        empty_object = linked("group", None, (x, -1.8, 0.5))
        empty_object.instance_type, empty_object.instance_collection = "COLLECTION", group
    camera()
    lamp("SUN", 3.0, (2, -3, 5))


def transforms():
    """A mirrored, a sheared and a flattened object, and one with a matrix of zero scale."""
    stage()
    material = bpy.data.materials["red"]
    sphere("mirrored", material, 0.4, location=(-0.7, -1.5, 0.4), scale=(-1, 1, 1.4))
    parent = linked("stretch", None, (0.9, -1.6, 0.4), scale=(1.6, 0.5, 0.8))
    child = cube("sheared", material, 0.6, rotation=(0, 0, 0.7))
    child.parent = parent
    sphere("flat", material, 0.4, location=(2.6, -1.2, 0.02), scale=(1, 1, 0.0))
    cube("nothing", material, location=(0, -2, 0.5), scale=(0, 0, 0))
    lamp("SUN", 3.0, (3, -2, 5))


def nan_vertices():
    """A mesh with NaN and infinite vertices beside a healthy one."""
    stage()
    bad = bpy.data.objects["box"].data
    broken = np.empty(len(bad.vertices) * 3, np.float32)
    bad.vertices.foreach_get("co", broken)
    broken[0], broken[7] = math.nan, math.inf
    bad.vertices.foreach_set("co", broken)
    lamp("SUN", 3.0, (3, -2, 5))


def missing_texture():
    """A floor whose picture cannot be found, and one whose node has none."""
    lost = bpy.data.images.new("lost", 4, 4)
    lost.source, lost.filepath = "FILE", "//no/such/picture.png"
    for x, picture in ((-2, lost), (2, None)):
        material, node = principled("lost")
        material.node_tree.links.new(image_node(material, picture).outputs["Color"], node.inputs["Base Color"])
        rectangle("floor", material, (3.6, 4), location=(x, 0, 0))
    camera()
    lamp("SUN", 3.0, (3, -2, 5))


def no_camera():
    """Objects and a lamp without a camera."""
    sun()
    bpy.data.objects.remove(bpy.data.objects["camera"])


def empty():
    """A camera and nothing else."""
    camera()


def orthographic():
    """The sun scene seen by an orthographic camera whose picture is shifted."""
    stage()
    lamp("SUN", 3.0, (3, -2, 5))
    data = bpy.context.scene.camera.data
    data.type, data.ortho_scale, data.shift_x, data.shift_y = "ORTHO", 7.0, 0.05, -0.04


# --- common ---------------------------------------------------------------------------------------------


def image(name, pixels, data=False):
    """A packed 8-bit image of float[H, W, 4], row 0 at the bottom."""
    made = bpy.data.images.new(name, pixels.shape[1], pixels.shape[0], alpha=True)
    made.colorspace_settings.name = "Non-Color" if data else "sRGB"
    made.pixels.foreach_set(np.ascontiguousarray(pixels, np.float32).ravel())
    made.update()
    made.pack()
    return made


def image_node(material, picture):
    """An Image Texture node in the material."""
    node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = picture
    return node


NAMES = ("sun", "point", "spot", "area", "four_lamps", "soft_lamps", "glow", "mirrors", "alpha_card", "normal_map", "instances", "transforms",
         "nan_vertices", "missing_texture", "no_camera", "empty", "orthographic")


def build(name):
    """Empties the file and builds one of NAMES; raises KeyError for another name."""
    make = {known: globals()[known] for known in NAMES}[name]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 160, 90, 100
    scene.view_settings.view_transform = "Standard"
    if hasattr(scene, "cycles"):
        # Debian's Blender has no denoiser and refuses to render where one is asked for.
        scene.cycles.use_denoising = False
    world = bpy.data.worlds.new("black")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.0
    scene.world = world
    make()
    bpy.context.view_layer.update()
