# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes confined.blend and colonnade.blend beside this script: places where one view misses many occluders.

    blender -b --factory-startup -P blend_scenes/make_occlusion.py

confined   a storeroom: partitions, cartons and pipes, all upright and close to each other. Its tubes glow, and
           its one lamp shines into a side room, so that no shadow map holds what the camera sees.
colonnade  a paved yard with columns, piers and crates under a sun whose shadow map holds most of it. In 60 frames
           the camera walks along the columns, which hide and show what stands behind them.

Few triangles, no textures: they are measured many times. The same script makes the same scenes.
"""

import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import shapes  # noqa: E402
from exhibits.gallery import plain  # noqa: E402
from staging import boxes, camera, crates, lamp, move, save, start, turned_box, world  # noqa: E402


def pipe(radius, height, segments=12):
    """An open upright tube."""
    return shapes.lathe([(radius, 0.0), (radius, height)], segments)


def make_confined():
    """The storeroom: 5 x 14 x 2.8 m and a side room behind it, the camera in its aisle."""
    scene = start()
    chalk, grey = plain("chalk", (0.75, 0.72, 0.67), 0.9), plain("concrete", (0.5, 0.5, 0.5), 0.9)
    wood, card = plain("wood", (0.45, 0.28, 0.14), 0.7), plain("cardboard", (0.58, 0.42, 0.25), 0.9)
    iron = plain("iron", (0.2, 0.22, 0.25), 0.5)
    left, right, near, far, end, height = -2.5, 2.5, -4.0, 10.0, 12.2, 2.8
    boxes("room", chalk, [
        ((left - 0.2, near - 0.2, 0.0), (left, end + 0.2, height)),
        ((right, near - 0.2, 0.0), (right + 0.2, end + 0.2, height)),
        ((left, near - 0.2, 0.0), (right, near, height)),
        # The wall before the side room, with a doorway.
        ((left, far, 0.0), (0.9, far + 0.2, height)),
        ((1.7, far, 0.0), (right, far + 0.2, height)),
        ((left, end, 0.0), (right, end + 0.2, height)),
    ])
    boxes("floor and ceiling", grey, [((left - 0.2, near - 0.2, -0.2), (right + 0.2, end + 0.2, 0.0)),
                                      ((left - 0.2, near - 0.2, height), (right + 0.2, end + 0.2, height + 0.2))])
    # Partitions up to the ceiling stand with their ends to the camera, a step apart: of each it sees one side at
    # most, and what is between them is occluded by both.
    rows = ((1.8, (-0.8, -0.5, 0.45, 0.75)), (3.4, (-1.0, -0.68, -0.2, 0.12, 0.5, 0.85)), (5.0, (-0.75, -0.4, 0.25, 0.6, 1.0)),
            (6.6, (-0.9, -0.5, -0.1, 0.25, 0.7, 1.05)))
    boxes("partitions", wood, [((x - 0.04, y, 0.0), (x + 0.04, y + 0.8, height)) for y, xs in rows for x in xs])
    crates("cartons", card, [(-1.1, 8.2, 3), (0.2, 8.3, 4), (1.2, 8.2, 2)], 7)
    first = pipe(0.06, height).object("pipe", iron, (-0.35, 8.6, 0.0))
    for index, x in enumerate((-0.15, 0.05, 0.25)):
        shapes.instance(f"pipe {index}", first.data, (x, 8.6, 0.0))
    glow = plain("tube", (0.0, 0.0, 0.0))
    node = glow.node_tree.nodes["Principled BSDF"]
    (node.inputs.get("Emission") or node.inputs["Emission Color"]).default_value = (1.0, 0.95, 0.85, 1.0)
    node.inputs["Emission Strength"].default_value = 9.0
    boxes("tubes", glow, [((-0.04, y, height - 0.06), (0.04, y + 1.2, height - 0.02)) for y in (-0.4, 2.6, 5.6)])
    lamp("side lamp", "SPOT", 120.0, (-2.2, 10.5, 2.5), (-1.2, 11.6, 0.0), spot_size=math.radians(55.0), shadow_soft_size=0.03)
    world((0.8, 0.9, 1.0), 0.25)
    camera((0.02, -1.2, 1.6), (0.0, 5.0, 1.2), 35.0)
    return scene


def make_colonnade():
    """The yard: the camera walks 3 m to the right along the columns, looking through them."""
    scene = start()
    stone, paving = plain("stone", (0.7, 0.64, 0.54), 0.9), plain("paving", (0.45, 0.43, 0.4), 0.9)
    wood = plain("wood", (0.4, 0.25, 0.13), 0.7)
    boxes("ground", paving, [((-8.0, -4.0, -0.2), (8.0, 9.0, 0.0))])
    boxes("walls", stone, [((-6.5, 6.5, 0.0), (6.5, 6.8, 2.2)), ((-6.8, 1.0, 0.0), (-6.5, 6.8, 2.2)),
                           ((-3.2, 4.6, 0.0), (-2.9, 6.5, 1.6)), ((0.6, 4.9, 0.0), (0.9, 6.5, 1.6)), ((3.4, 4.4, 0.0), (3.7, 6.5, 1.6))])
    boxes("steps", stone, [((-6.5, 6.0 - 0.3 * i, 0.0), (6.5, 6.5, 0.14 * (3 - i) - 0.04)) for i in range(3)])
    column = shapes.lathe([(0.24, 0.0), (0.24, 0.12), (0.24, 0.12), (0.17, 0.14), (0.15, 2.3), (0.15, 2.3), (0.22, 2.4), (0.22, 2.5)], 20)
    first = column.object("column", stone, (-4.0, 1.3, 0.0))
    for index in range(1, 8):
        shapes.instance(f"column {index}", first.data, (-4.0 + 1.15 * index, 1.3 + 0.25 * (index % 2), 0.0))
    piers = shapes.Shape()
    for index, x in enumerate((-4.6, -3.3, -1.8, -0.4, 1.5, 2.7, 4.4)):
        turned_box(piers, (x, 3.1 + 0.35 * (index % 3), 0.0), (0.3, 0.3, 1.1 + 0.2 * (index % 2)), 0.3 * index)
    piers.object("piers", stone)
    crates("crates", wood, [(-3.9, 3.6, 2), (-2.4, 4.1, 2), (-1.2, 4.5, 3), (0.2, 3.9, 2), (1.9, 4.2, 2), (2.9, 4.7, 1), (-0.7, 2.3, 1),
                            (2.1, 2.4, 1), (-2.7, 2.3, 1), (3.6, 3.3, 2)], 3)
    lamp("sun", "SUN", 2.5, (5.0, -2.0, 8.0), (0.0, 2.5, 0.0), angle=math.radians(0.53))
    world((0.45, 0.65, 1.0), 0.5)
    made = camera((-1.5, -1.2, 1.5), (-1.2, 4.0, 0.5), 26.0)
    move(made, "location", 1.5, 0)
    return scene


for name, make in (("confined", make_confined), ("colonnade", make_colonnade)):
    make()
    save(HERE, name)
