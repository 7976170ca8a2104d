# SPDX-License-Identifier: GPL-3.0-or-later
"""A lamp of every kind, each over a plinth of its own, and a world with a horizon."""

import math

import bpy
import numpy as np

from exhibits.gallery import above, thing


def horizon():
    """A packed panorama in floating point: evening sky over dark ground, with a bright band."""
    width, height = 64, 32
    v = (np.arange(height) + 0.5) / height
    sky = np.array([0.16, 0.26, 0.5]) + np.exp(-((v[:, None] - 0.5) / 0.12) ** 2) * np.array([1.1, 0.55, 0.25])
    ground = np.array([0.09, 0.08, 0.07]) * np.ones((height, 1))
    color = np.where(v[:, None] > 0.5, sky, ground)
    pixels = np.ones((height, width, 4), np.float32)
    pixels[..., :3] = color[:, None, :] * (0.8 + 0.2 * np.cos(np.arange(width) / width * math.tau))[None, :, None]
    image = bpy.data.images.new("horizon", width, height, float_buffer=True)
    image.pixels.foreach_set(pixels.ravel())
    image.update()
    image.pack()
    return image


def world():
    """The panorama mixed with a gradient from below to above."""
    made = bpy.data.worlds.new("evening")
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    background = nodes["Background"]
    panorama, gradient, ramp, mix, place, parts, raised = (nodes.new("ShaderNode" + kind) for kind in (
        "TexEnvironment", "TexGradient", "ValToRGB", "MixRGB", "TexCoord", "SeparateXYZ", "Mapping"))
    panorama.image = horizon()
    ramp.color_ramp.elements[0].color, ramp.color_ramp.elements[1].color = (0.5, 0.2, 0.1, 1.0), (0.1, 0.2, 0.5, 1.0)
    links.new(place.outputs["Generated"], parts.inputs[0])
    links.new(parts.outputs[2], raised.inputs["Vector"])
    links.new(raised.outputs[0], gradient.inputs[0])
    links.new(gradient.outputs["Fac"], ramp.inputs["Fac"])
    links.new(panorama.outputs["Color"], mix.inputs["Color1"])
    links.new(ramp.outputs["Color"], mix.inputs["Color2"])
    mix.inputs["Fac"].default_value = 0.3
    links.new(mix.outputs["Color"], background.inputs["Color"])
    background.inputs["Strength"].default_value = 0.4
    bpy.context.scene.world = made


def _lamp(name, kind, energy, place, color=(1.0, 1.0, 1.0), rotation=(0.0, 0.0, 0.0), **settings):
    light = bpy.data.lights.new(name, kind)
    light.energy, light.color = energy, color
    for key, value in settings.items():
        setattr(light, key, value)
    return thing(name, light, place, rotation_euler=rotation)


def lamps(row, marble):
    """Small lamps, each shining on a ball of marble."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12, radius=0.22)
    ball = bpy.context.object
    mesh = ball.data
    mesh.name = "ball"
    mesh.materials.append(marble)
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    bpy.data.objects.remove(ball)

    def stand():
        place = row.place()
        thing("ball", mesh, above(place, 0.22))
        return above(place, 0.95)

    _lamp("point", "POINT", 18.0, stand(), (1.0, 0.5, 0.3), shadow_soft_size=0.0)
    _lamp("soft point", "POINT", 18.0, stand(), (0.3, 0.7, 1.0), shadow_soft_size=0.15)
    _lamp("spot", "SPOT", 50.0, stand(), (0.5, 1.0, 0.5), spot_size=0.9, spot_blend=0.3, shadow_soft_size=0.0)
    _lamp("soft spot", "SPOT", 50.0, stand(), (1.0, 0.4, 0.9), spot_size=1.2, spot_blend=1.0, shadow_soft_size=0.1)
    for shape, size_y in (("SQUARE", 0.0), ("RECTANGLE", 0.15), ("DISK", 0.0), ("ELLIPSE", 0.2)):
        made = _lamp(shape.lower(), "AREA", 10.0, stand(), (1.0, 0.85, 0.6), shape=shape, size=0.5)
        made.data.size_y = size_y or made.data.size_y
    _lamp("narrow area", "AREA", 10.0, stand(), (0.6, 0.85, 1.0), size=0.4, spread=math.radians(40.0))
    _lamp("no shadow", "POINT", 18.0, stand(), (1.0, 1.0, 0.4)).data.use_shadow = False
    _lamp("off", "POINT", 0.0, stand())
    shining = _lamp("nodes", "POINT", 18.0, stand())
    shining.data.use_nodes = True
    shining.data.node_tree.nodes["Emission"].inputs["Color"].default_value = (1.0, 0.3, 0.1, 1.0)
    odd = _lamp("odd nodes", "POINT", 18.0, stand(), (0.4, 0.4, 1.0))
    odd.data.use_nodes = True
    tree = odd.data.node_tree
    tree.links.new(tree.nodes.new("ShaderNodeBlackbody").outputs[0], tree.nodes["Emission"].inputs["Color"])
    _lamp("sun", "SUN", 1.4, (0.0, 0.0, 8.0), (1.0, 0.9, 0.75), (0.75, 0.25, 0.4), angle=0.03)
