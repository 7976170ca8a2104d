# SPDX-License-Identifier: GPL-3.0-or-later
"""What scripts of small scenes share: an empty file, boxes, lamps, a camera, and things that move evenly.

Few triangles, no textures: such scenes are measured many times. Lengths in metres, z up.
"""

import math
import random

import bpy
from mathutils import Vector

import shapes
from exhibits.gallery import thing

FRAMES = 60


def boxes(name, material, corners):
    """One object of boxes, each between two corners."""
    shape = shapes.Shape()
    for low, high in corners:
        shape.box(low, high)
    return shape.object(name, material)


def turned_box(shape, middle, size, turn):
    """Adds a box that stands on z = middle's, turned about its own upright axis."""
    box = shapes.Shape()
    box.box((-size[0] / 2, -size[1] / 2, 0.0), (size[0] / 2, size[1] / 2, size[2]))
    cos, sin = math.cos(turn), math.sin(turn)
    place = [(middle[0] + cos * x - sin * y, middle[1] + sin * x + cos * y, middle[2] + z) for x, y, z in box.vertices]
    for face in range(6):
        shape.face(place[4 * face:4 * face + 4], box.uvs[4 * face:4 * face + 4])


def crates(name, material, stacks, seed):
    """Stacks of crates at (x, y, how many), each turned a little from the one below."""
    shape, dice = shapes.Shape(), random.Random(seed)
    for x, y, count in stacks:
        z = 0.0
        for _ in range(count):
            size = [dice.uniform(0.38, 0.55), dice.uniform(0.38, 0.5), dice.uniform(0.3, 0.48)]
            turned_box(shape, (x + dice.uniform(-0.05, 0.05), y + dice.uniform(-0.05, 0.05), z), size, dice.uniform(-0.4, 0.4))
            z += size[2]
    return shape.object(name, material)


def aim(made, target):
    """Turns a lamp's or camera's -z to a point."""
    made.rotation_euler = (Vector(target) - made.location).to_track_quat("-Z", "Y").to_euler()
    return made


def lamp(name, kind, energy, location, target, **settings):
    light = bpy.data.lights.new(name, kind)
    light.energy = energy
    for key, value in settings.items():
        setattr(light, key, value)
    return aim(thing(name, light, location), target)


def camera(location, target, lens):
    data = bpy.data.cameras.new("camera")
    data.lens = lens
    made = aim(thing("camera", data, location), target)
    bpy.context.scene.camera = made
    return made


def world(color, strength):
    made = bpy.data.worlds.new("world")
    made.use_nodes = True
    background = made.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (*color, 1.0)
    background.inputs["Strength"].default_value = strength
    bpy.context.scene.world = made


def start():
    """An empty file of 480x270 pixels."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 480, 270, 100
    scene.view_settings.view_transform = "Filmic"
    if hasattr(scene, "cycles"):
        scene.render.engine = "CYCLES"
        scene.cycles.samples, scene.cycles.seed = 64, 1
        # Debian's Blender has no denoiser and refuses to render where one is asked for.
        scene.cycles.use_denoising = False
    return scene


def move(made, path, end, index=-1):
    """Lets a property of an object ("location", "rotation_euler") go evenly from what it is to `end` in FRAMES frames.

    index: of the only component that moves, -1 for all; `end` is as many numbers.
    """
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, FRAMES
    made.keyframe_insert(path, index=index, frame=1)
    if index < 0:
        setattr(made, path, end)
    else:
        getattr(made, path)[index] = end
    made.keyframe_insert(path, index=index, frame=FRAMES)
    for curve in made.animation_data.action.fcurves:
        for key in curve.keyframe_points:
            key.interpolation = "LINEAR"
    scene.frame_set(1)


def save(folder, name):
    """Writes the scene as NAME.blend, compressed, without the place where the file browser last was on this machine."""
    browsers = [space for screen in bpy.data.screens for area in screen.areas for space in area.spaces if space.type == "FILE_BROWSER"]
    for browser in browsers:
        browser.params.directory = b"//"
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / f"{name}.blend"), compress=True)
