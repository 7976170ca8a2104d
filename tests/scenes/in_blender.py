# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders scenes into EXR files, one after the other; runs inside Blender, started by renders.py.

    blender -b --factory-startup -P in_blender.py

Takes jobs from standard input, the path of a JSON file a line, until it ends. A job: {"scene": path of a .blend, "builder:NAME" or "nodes:GROUP", "lamps_alone": bool, "size": [width, height] or null,
"renders": [{"engine": "CYCLES" or "PANOPTES", "out": path, "samples": n, "shadows": bool, "seed": n,
"lamp": index of the only lamp that shines, or null for all, "method": of Panoptes or null, "bounces": of indirect light or null}]}. Lamps are counted in the order of their names.
A job's scene is loaded once; nothing is ever saved over it. Prints "lamps: N" after each job. What a job leaves behind
(Panoptes' compiled programs) makes the next one faster.
"""

import json
import sys
from pathlib import Path

import bpy

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(Path(__file__).resolve().parent))

# Every pass that both engines have.
PASSES = ("combined", "z", "normal", "diffuse_color", "diffuse_direct", "diffuse_indirect", "glossy_color", "glossy_direct", "glossy_indirect",
          "transmission_color", "transmission_direct", "transmission_indirect", "emit", "environment")


def lamps_alone():
    """Turns off the world and what glows; makes every lamp a point or a direction without changing its power."""
    for material in bpy.data.materials:
        for node in material.node_tree.nodes if material.use_nodes else ():
            name = {"EMISSION": "Strength", "BSDF_PRINCIPLED": "Emission Strength"}.get(node.type)
            if name:
                for link in list(node.inputs[name].links):
                    material.node_tree.links.remove(link)
                node.inputs[name].default_value = 0.0
    world = bpy.context.scene.world
    if world is not None:
        if world.use_nodes:
            for node in world.node_tree.nodes:
                if node.type == "BACKGROUND":
                    for link in list(node.inputs["Strength"].links):
                        world.node_tree.links.remove(link)
                    node.inputs["Strength"].default_value = 0.0
        else:
            world.color = (0.0, 0.0, 0.0)
    for light in bpy.data.lights:
        if light.type == "SUN":
            light.angle = 0.0
        elif light.type == "AREA":
            # A disk, since Cycles loses precision on tiny squares; the power is that of the whole lamp.
            light.shape, light.size = "DISK", 0.001
        else:
            light.shadow_soft_size = 0.0


def lamps():
    """The objects that shine, by name."""
    return sorted((made for made in bpy.context.scene.objects if made.type == "LIGHT"), key=lambda made: made.name)


def prepare(scene, job):
    """What all renders of the job share: size, passes, file format, no post-processing."""
    if job["lamps_alone"]:
        lamps_alone()
    if job["size"]:
        scene.render.resolution_x, scene.render.resolution_y = job["size"]
        scene.render.resolution_percentage = 100
    scene.render.use_compositing = scene.render.use_sequencer = False
    scene.render.use_border = False
    for layer in scene.view_layers:
        for name in PASSES:
            setattr(layer, f"use_pass_{name}", True)
    settings = scene.render.image_settings
    if hasattr(settings, "media_type"):  # since Blender 5.0 the format depends on it
        settings.media_type = "MULTI_LAYER_IMAGE"
    settings.file_format, settings.color_depth, settings.exr_codec = "OPEN_EXR_MULTILAYER", "32", "ZIP"


def use_cycles(scene, render, direct_only):
    """The unbiased settings of a reference."""
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device, cycles.samples, cycles.seed = "CPU", render["samples"], render["seed"]
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0.0
    # A lamp's dim contributions must not be dropped at random.
    cycles.light_sampling_threshold = 0.0
    if direct_only:
        cycles.max_bounces = 0
    elif render["bounces"] is not None:
        cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = render["bounces"]
    for light in bpy.data.lights:
        light.use_shadow = render["shadows"]
        if hasattr(light.cycles, "cast_shadow"):  # Cycles' own switch, until Blender 4.2
            light.cycles.cast_shadow = render["shadows"]


def use_panoptes(scene, render):
    """The engine of this project with the settings that the file has, but those that the job names."""
    if "panoptes" not in sys.modules:
        sys.path.insert(0, str(ROOT / "addon"))
        import panoptes
        panoptes.register()
    scene.render.engine = "PANOPTES"
    if not render["shadows"]:
        # Surfaces alone are compared: neither do lamps cast shadows nor is the world's light occluded.
        scene.panoptes.ambient_occlusion.strength = 0.0
    if render["samples"]:
        scene.panoptes.samples = render["samples"]
    if render["bounces"] is not None:
        scene.panoptes.bounces = scene.panoptes.radiance_cache.bounces = render["bounces"]
    if render["method"]:
        from panoptes import passes
        scene.panoptes.method, scene.panoptes.seed = render["method"], render["seed"]
        for layer in scene.view_layers:
            passes.enable_all(layer, render["method"])


def run(job):
    """Does one job."""
    if job["scene"].startswith("builder:"):
        import builders
        builders.build(job["scene"].removeprefix("builder:"))
    elif job["scene"].startswith("nodes:"):
        import node_atlas
        node_atlas.build(job["scene"].removeprefix("nodes:"))
    else:
        bpy.ops.wm.open_mainfile(filepath=job["scene"])
    scene = bpy.context.scene
    prepare(scene, job)
    shining = [made for made in lamps() if not made.hide_render]
    for render in job["renders"]:
        for index, made in enumerate(shining):
            made.hide_render = render["lamp"] not in (None, index)
        if render["engine"] == "CYCLES":
            use_cycles(scene, render, job["lamps_alone"])
        else:
            use_panoptes(scene, render)
        scene.render.filepath = render["out"]
        bpy.ops.render.render(write_still=True)
    print("lamps:", len(shining), flush=True)


for line in sys.stdin:
    run(json.loads(Path(line.strip()).read_text()))
