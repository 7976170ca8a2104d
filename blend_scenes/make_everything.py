# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes everything.blend beside this script: a museum of all that a scene can hold.

    blender -b --factory-startup -P blend_scenes/make_everything.py

Rows of plinths on one floor: closures, textures, shapes, odd meshes and lamps; and among them whatever
is broken, hidden or not supported, so that a render of it tells the artist so and goes on. Needs
Blender 3.4; the file opens in later versions. Everything, images included, is computed here.
"""

import sys
from pathlib import Path

import bpy

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

from exhibits import lighting, objects, surfaces  # noqa: E402
from exhibits.gallery import COLUMNS, ROW_DEPTH, SPACING, Row, plain, thing  # noqa: E402
import textures  # noqa: E402


def floor():
    """Tiles under all rows, and a wall behind them."""
    wide, deep = 0.5 * COLUMNS * SPACING + 3.2, 9 * ROW_DEPTH
    made = bpy.data.materials.new("floor")
    made.use_nodes = True
    image = made.node_tree.nodes.new("ShaderNodeTexImage")
    image.image = textures.packed("floor tiles", textures.tiles(128))
    principled = made.node_tree.nodes["Principled BSDF"]
    made.node_tree.links.new(image.outputs["Color"], principled.inputs["Base Color"])
    principled.inputs["Roughness"].default_value = 0.6
    for name, corners, scale in (
            ("floor", [(-wide, -1.6, 0.0), (wide, -1.6, 0.0), (wide, deep, 0.0), (-wide, deep, 0.0)], (wide / 1.2, deep / 2.4)),
            ("wall", [(-wide, deep, 0.0), (wide, deep, 0.0), (wide, deep, 2.4), (-wide, deep, 2.4)], None)):
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata(corners, [], [(0, 1, 2, 3)])
        layer = mesh.uv_layers.new(name="UVMap")
        across, along = scale or (1.0, 1.0)
        layer.data.foreach_set("uv", [0.0, 0.0, across, 0.0, across, along, 0.0, along])
        mesh.materials.append(made if scale else plain("wall", (0.5, 0.42, 0.34), 0.9))
        mesh.update()
        thing(name, mesh, (0.0, 0.0, 0.0))


def camera():
    """A camera that sees all, with depth of field."""
    from mathutils import Vector
    made = bpy.data.cameras.new("camera")
    made.lens, made.clip_end = 40.5, 200.0
    made.dof.use_dof, made.dof.focus_distance, made.dof.aperture_fstop = True, 20.0, 4.0
    stand = thing("camera", made, (0.0, -15.2, 13.6))
    stand.rotation_euler = (Vector((0.0, 5.3, 0.0)) - stand.location).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.camera = stand


def main():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    lighting.world()
    floor()
    marble = plain("marble", (0.8, 0.79, 0.76), 0.35)
    rows = [Row(title, number, marble) for number, title in enumerate((
        "Closures", "More closures", "Textures", "Nodes", "Shapes", "Meshes", "Others", "Lamps"))]
    sphere = surfaces.sphere_mesh()
    for row, group in zip(rows, (*surfaces.closures(), *surfaces.patterns())):
        for name, build in group:
            surfaces.show(row, sphere, name, build)
    paints = [plain("terracotta", (0.62, 0.25, 0.15)), plain("sage", (0.35, 0.45, 0.3)), plain("brass", (0.8, 0.6, 0.25), 0.3, 1.0)]
    objects.furnish(rows[4:6], paints)
    objects.not_rendered_yet(rows[6], paints[0])
    surfaces.cut_out(rows[6])
    objects.silent()
    lighting.lamps(rows[7], marble)
    camera()

    scene.frame_start, scene.frame_end = 1, 3
    scene.frame_set(1)
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 960, 540, 100
    scene.render.image_settings.file_format = "PNG"
    scene.view_settings.view_transform = "Filmic"
    if hasattr(scene, "cycles"):
        scene.render.engine = "CYCLES"
        scene.cycles.samples, scene.cycles.seed = 128, 1
        # Debian's Blender has no denoiser and refuses to render where one is asked for.
        scene.cycles.use_denoising = False
    bpy.ops.wm.save_as_mainfile(filepath=str(HERE / "everything.blend"), compress=True)


main()
