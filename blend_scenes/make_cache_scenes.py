# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes canyon.blend, two_spots.blend and doorway.blend beside this script: places where bounced light decides.

    blender -b --factory-startup -P blend_scenes/make_cache_scenes.py

canyon     outdoors: a winding gorge of red and pale rock under a sun and a blue sky, with thin arches and a slab across
           it. One wall is lit, the other shows what it reflects.
two_spots  a grey hall with piers along its walls; a red and a green spot lamp shine from opposite ends, as in Figure 5.8
           of the dissertation: each cell of a cache sees one colour ahead and the other behind.
doorway    a dark room that gets light only through a door in a wall of 0.1 m, from a room with a strong lamp. A bright
           sky surrounds the closed house: whatever of it is seen inside has leaked.

In each, the camera moves and a lamp moves slowly for 60 frames. No textures. The same script makes the same scenes.
"""

import math
import sys
from pathlib import Path

from mathutils import Vector, noise

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import shapes  # noqa: E402
from exhibits.gallery import plain  # noqa: E402
from staging import boxes, camera, crates, lamp, move, save, start, turned_box, world  # noqa: E402

# --- the canyon -------------------------------------------------------------------------------------------------

LENGTH, RIM = 48.0, 11.0  # metres along y, and from the floor to the plateau
# Across the canyon: (x, z) of the profile's corners, from plateau to plateau, and where the materials change.
PROFILE = ((-22.0, RIM), (-7.5, RIM), (-6.2, 6.5), (-4.9, 6.2), (-4.2, 0.3), (-3.2, 0.0), (3.2, 0.0), (4.0, 0.4),
           (4.6, 4.6), (6.4, 5.0), (7.4, RIM), (22.0, RIM))
RED_WALL, FLOOR, PALE_WALL = (0, 5), (5, 6), (6, 11)
ROUGHNESS_METRES = 0.9


def middle(y):
    """x of the canyon's middle: it winds."""
    return 2.2 * math.sin(y * 0.16) + 0.8 * math.sin(y * 0.41 + 1.0)


def rock(s, y):
    """A point of the canyon's surface; s runs along the profile's corners."""
    corner = min(int(s), len(PROFILE) - 2)
    t = s - corner
    x, z = ((1.0 - t) * a + t * b for a, b in zip(PROFILE[corner], PROFILE[corner + 1]))
    place = Vector((x, y, z))
    rough = 0.25 if PROFILE[corner][1] < 0.5 > PROFILE[corner + 1][1] else 1.0
    # Layers of rock stand out by turns: they lie level but for a slow wave.
    layers = 0.35 * math.sin(2.3 * z + 0.6 * noise.noise(Vector((0.1 * x, 0.1 * y, 0.0)))) * min(z / 2.0, 1.0)
    bump = noise.fractal(place * 0.28, 1.0, 2.0, 4) * ROUGHNESS_METRES * rough
    outward = math.copysign(1.0, x) if abs(x) > 3.0 else 0.0
    return x + middle(y) + outward * (layers + bump), y, z + 0.3 * bump


def canyon_part(name, material, corners, steps, rows=110):
    """The surface between two of the profile's corners, `steps` quads between each pair."""
    shape = shapes.Shape()
    across = [corners[0] + i / steps for i in range((corners[1] - corners[0]) * steps + 1)]
    along = [LENGTH * (i / rows - 0.3) for i in range(rows + 1)]
    # Rows run against y, so that faces look into the canyon.
    points = [[rock(s, y) for s in across] for y in along]
    shape.grid(points, [[(s, y) for s in across] for y in along])
    return shape.object(name, material)


def arch(name, material, y, height, radius, thickness, segments=48, around=12):
    """A thin bridge of rock from wall to wall at y, a bent tube that is rough; its top stands `height` high."""
    shape, rows = shapes.Shape(), []
    for i in range(segments + 1):
        angle = math.pi * i / segments
        spine = Vector((middle(y) - radius * math.cos(angle), y + 0.4 * math.cos(2.0 * angle), height - radius * 0.45 * (1.0 - math.sin(angle))))
        out = Vector((-math.cos(angle), 0.0, math.sin(angle)))
        row = []
        for j in range(around):
            turn = 2.0 * math.pi * j / around
            reach = thickness * (1.0 + 0.35 * noise.noise(spine * 0.9 + Vector((math.cos(turn), math.sin(turn), y))))
            row.append(tuple(spine + reach * (math.cos(turn) * out + math.sin(turn) * Vector((0.0, 1.0, 0.0)))))
        rows.append(row)
    shape.grid(rows, [[(j / around, i) for j in range(around)] for i in range(segments + 1)], closed=True)
    return shape.object(name, material)


def boulder(shape, place, radius, seed, segments=16):
    """Adds a rough ball that is half in the ground."""
    rows = []
    for i in range(segments // 2 + 1):
        polar = math.pi * i / (segments // 2)
        row = []
        for j in range(segments):
            turn = 2.0 * math.pi * j / segments
            way = Vector((math.sin(polar) * math.cos(turn), math.sin(polar) * math.sin(turn), -math.cos(polar)))
            row.append(tuple(Vector(place) + way * radius * (1.0 + 0.5 * noise.noise(way * 1.4 + Vector((7.0 * seed, 0.0, 0.0))))))
        rows.append(row)
    shape.grid(rows, [[(j / segments, i) for j in range(segments)] for i in range(len(rows))], closed=True)


def make_canyon():
    """The gorge: 48 m long, 11 m deep; the camera walks 4 m through it, the sun turns by 3 degrees."""
    start()
    red, pale = plain("red rock", (0.56, 0.22, 0.1), 0.95), plain("pale rock", (0.66, 0.55, 0.4), 0.95)
    sand, dark = plain("sand", (0.5, 0.38, 0.24), 0.95), plain("dark rock", (0.2, 0.17, 0.15), 0.9)
    canyon_part("red wall", red, RED_WALL, 9)
    canyon_part("floor", sand, FLOOR, 12)
    canyon_part("pale wall", pale, PALE_WALL, 9)
    arch("near arch", pale, 9.5, 6.4, 5.6, 0.3)
    arch("far arch", red, 17.0, 8.6, 6.2, 0.4)
    boxes("slab", dark, [((middle(13.0) - 7.0, 12.4, 7.6), (middle(13.0) + 7.0, 13.3, 7.8))])
    stones = shapes.Shape()
    for seed, (x, y, radius) in enumerate(((-2.0, 5.0, 0.7), (1.8, 7.5, 0.5), (-1.2, 10.5, 0.9), (2.3, 13.0, 0.8), (0.3, 16.0, 0.6), (-2.4, 20.0, 1.1))):
        boulder(stones, (x + middle(y), y, 0.15 * radius), radius, seed)
    stones.object("boulders", dark)
    sun = lamp("sun", "SUN", 4.0, (12.0, -4.0, 20.0), (0.0, 2.0, 0.0), angle=math.radians(0.53), color=(1.0, 0.95, 0.87))
    move(sun, "rotation_euler", sun.rotation_euler[2] + math.radians(3.0), 2)
    world((0.35, 0.55, 1.0), 0.6)
    eye = camera((middle(-3.0) + 0.4, -3.0, 1.7), (middle(11.0), 11.0, 3.4), 24.0)
    move(eye, "location", 1.0, 1)


# --- the hall ---------------------------------------------------------------------------------------------------

HALL = (8.0, 20.0, 5.0)
PIERS = (2.5, 5.5, 8.5, 11.5, 14.5, 17.5)
# Metres that a pier stands out from its wall, and its width along it.
PIER_DEPTH, PIER_WIDTH = 0.9, 0.6


def make_two_spots():
    """The hall: 8 x 20 x 5 m; the camera walks 2 m along it, the red lamp turns by 3 degrees."""
    start()
    white, grey = plain("plaster", (0.8, 0.8, 0.8), 0.95), plain("floor", (0.55, 0.55, 0.55), 0.95)
    half, length, height = HALL[0] / 2, HALL[1], HALL[2]
    boxes("hall", white, [((-half - 0.3, -0.3, 0.0), (-half, length + 0.3, height)), ((half, -0.3, 0.0), (half + 0.3, length + 0.3, height)),
                          ((-half, -0.3, 0.0), (half, 0.0, height)), ((-half, length, 0.0), (half, length + 0.3, height)),
                          ((-half - 0.3, -0.3, height), (half + 0.3, length + 0.3, height + 0.3))])
    boxes("ground", grey, [((-half - 0.3, -0.3, -0.3), (half + 0.3, length + 0.3, 0.0))])
    boxes("piers", white, [((side * half - (PIER_DEPTH if side > 0 else 0.0), y - PIER_WIDTH / 2, 0.0),
                            (side * half + (PIER_DEPTH if side < 0 else 0.0), y + PIER_WIDTH / 2, height)) for side in (-1, 1) for y in PIERS])
    balls = shapes.Shape()
    for seed, (x, y) in enumerate(((-1.6, 6.8), (1.5, 9.8), (-1.2, 13.0))):
        boulder(balls, (x, y, 0.55), 0.6, seed, 32)
    balls.object("stones", white)
    spot = {"spot_size": math.radians(70.0), "spot_blend": 0.3, "shadow_soft_size": 0.05}
    red = lamp("red lamp", "SPOT", 2500.0, (0.4, 0.6, 3.2), (0.0, 14.0, 1.0), color=(1.0, 0.06, 0.03), **spot)
    lamp("green lamp", "SPOT", 2500.0, (-0.4, length - 0.6, 3.2), (0.0, 6.0, 1.0), color=(0.05, 1.0, 0.08), **spot)
    move(red, "rotation_euler", red.rotation_euler[2] + math.radians(3.0), 2)
    world((0.0, 0.0, 0.0), 0.0)
    eye = camera((1.6, 1.2, 2.0), (-0.8, 12.0, 1.6), 22.0)
    move(eye, "location", 3.2, 1)


# --- the dark room ----------------------------------------------------------------------------------------------

THIN, THICK = 0.1, 0.2
ROOM_HEIGHT = 2.8
DOOR = (0.4, 1.4, 2.1)  # from and to along the wall, and its height


def make_doorway():
    """Two rooms, 6 x 5 and 4 x 5 m; the camera walks 1 m in the dark one, the lamp in the bright one 1 m."""
    start()
    chalk, floor = plain("chalk", (0.75, 0.73, 0.7), 0.95), plain("boards", (0.42, 0.3, 0.2), 0.9)
    wood, cloth = plain("wood", (0.45, 0.28, 0.14), 0.8), plain("cloth", (0.2, 0.3, 0.6), 0.95)
    left, wall, right, depth, height = -6.0, 0.0, 4.0, 5.0, ROOM_HEIGHT
    boxes("house", chalk, [
        ((left - THICK, -THICK, 0.0), (left, depth + THICK, height)), ((right, -THICK, 0.0), (right + THICK, depth + THICK, height)),
        ((left, -THICK, 0.0), (right, 0.0, height)), ((left, depth, 0.0), (right, depth + THICK, height)),
        ((left - THICK, -THICK, height), (right + THICK, depth + THICK, height + THICK))])
    boxes("thin wall", chalk, [((wall, 0.0, 0.0), (wall + THIN, DOOR[0], height)), ((wall, DOOR[1], 0.0), (wall + THIN, depth, height)),
                               ((wall, DOOR[0], DOOR[2]), (wall + THIN, DOOR[1], height))])
    boxes("ground", floor, [((left - THICK, -THICK, -THICK), (right + THICK, depth + THICK, 0.0))])
    boxes("table", wood, [((-3.6, 2.0, 0.7), (-2.0, 2.9, 0.75))] + [((x, y, 0.0), (x + 0.06, y + 0.06, 0.7)) for x in (-3.58, -2.08) for y in (2.02, 2.82)])
    bed = shapes.Shape()
    turned_box(bed, (-1.3, 4.2, 0.0), (2.0, 1.1, 0.5), 0.0)
    bed.object("bed", cloth)
    crates("boxes", wood, [(-0.8, 2.4, 2), (-4.9, 1.0, 3), (2.6, 4.2, 2)], 5)
    shapes.lathe([(0.0, 0.0), (0.16, 0.0), (0.16, 0.0), (0.2, 0.25), (0.14, 0.3)], 24).object("pot", cloth, (-2.9, 2.4, 0.75))
    sun = lamp("bright lamp", "AREA", 350.0, (2.2, 2.0, 2.7), (2.2, 2.0, 0.0), shape="RECTANGLE", size=1.6, size_y=1.0, color=(1.0, 0.93, 0.82))
    move(sun, "location", 3.0, 1)
    world((0.5, 0.7, 1.0), 1.0)
    eye = camera((-5.5, 1.2, 1.6), (-0.5, 2.6, 1.0), 22.0)
    move(eye, "location", 2.2, 1)


for name, make in (("canyon", make_canyon), ("two_spots", make_two_spots), ("doorway", make_doorway)):
    make()
    save(HERE, name)
