# SPDX-License-Identifier: GPL-3.0-or-later
"""Shapes for our own scenes, as plain lists of vertices, faces and one UV per face corner.

Everything is in metres with z up. UVs are in metres too where a shape is flat, so that one texture
scale fits every wall.
"""

import math

import bpy


class Shape:
    """Vertices, faces and corner UVs that grow by parts and end as one mesh."""

    def __init__(self):
        self.vertices, self.faces, self.uvs, self.smooth = [], [], [], []

    def face(self, corners, uvs, smooth=False):
        """Adds one face of its own vertices: corners and uvs in the same order, counter-clockwise from outside."""
        start = len(self.vertices)
        self.vertices += corners
        self.faces.append(tuple(range(start, start + len(corners))))
        self.uvs += uvs
        self.smooth.append(smooth)

    def grid(self, rows, uvs, smooth=True, closed=False):
        """Adds a surface through rows of points that share their vertices, so that it can be shaded smooth.

        rows: lists of points of equal length. uvs: the same shape. closed: the last column joins the first.
        """
        start, width = len(self.vertices), len(rows[0])
        self.vertices += [point for row in rows for point in row]
        for i in range(len(rows) - 1):
            for j in range(width if closed else width - 1):
                k = (j + 1) % width
                corners = ((i, j), (i, k), (i + 1, k), (i + 1, j))
                self.faces.append(tuple(start + a * width + b for a, b in corners))
                # Where the seam closes, u runs on to the end instead of back to the start.
                self.uvs += [uvs[a][b] if not (closed and b < j) else (uvs[a][width - 1][0] + uvs[a][1][0], uvs[a][b][1])
                             for a, b in corners]
                self.smooth.append(smooth)

    def box(self, low, high):
        """Adds an axis-aligned box between two corners, UVs in metres."""
        for axis in range(3):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            for side, order in ((low, ((0, 0), (0, 1), (1, 1), (1, 0))), (high, ((0, 0), (1, 0), (1, 1), (0, 1)))):
                corners = []
                for a, b in order:
                    corner = [0.0, 0.0, 0.0]
                    corner[axis], corner[u], corner[v] = side[axis], (low, high)[a][u], (low, high)[b][v]
                    corners.append(tuple(corner))
                # Keep the texture upright on walls: v follows z wherever the face contains it.
                flat = [[c[k] for k in range(3) if k != axis] for c in corners]
                self.face(corners, [tuple(point) for point in flat])

    def object(self, name, material, location=(0.0, 0.0, 0.0)):
        """Makes the mesh and an object of it in the scene's collection."""
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata(self.vertices, [], self.faces)
        layer = mesh.uv_layers.new(name="UVMap")
        layer.data.foreach_set("uv", [value for uv in self.uvs for value in uv])
        mesh.polygons.foreach_set("use_smooth", self.smooth)
        mesh.materials.append(material)
        mesh.update()
        return instance(name, mesh, location)


def instance(name, mesh, location=(0.0, 0.0, 0.0), turn=0.0, scale=1.0):
    """An object that shares a mesh; turn is about z, in radians."""
    made = bpy.data.objects.new(name, mesh)
    made.location = location
    made.rotation_euler = (0.0, 0.0, turn)
    made.scale = (scale, scale, scale)
    bpy.context.scene.collection.objects.link(made)
    return made


def lathe(profile, segments=32):
    """A solid of revolution about z. profile: (radius, z) upwards; a repeated point makes a sharp ring."""
    shape, runs = Shape(), [[]]
    for point in profile:
        if runs[-1] and runs[-1][-1] == point:
            runs.append([])
        runs[-1].append(point)
    around = [2.0 * math.pi * s / segments for s in range(segments)]
    for run in runs:
        rows = [[(r * math.cos(a), r * math.sin(a), z) for a in around] for r, z in run]
        shape.grid(rows, [[(s / segments, z) for s in range(segments)] for _, z in run], closed=True)
    return shape


def arch_points(width, spring, segments=20):
    """(across, height) of a semicircular arch from its left spring to its right one, centred on 0."""
    radius = width / 2.0
    return [(-radius * math.cos(math.pi * s / segments), spring + radius * math.sin(math.pi * s / segments))
            for s in range(segments + 1)]


def arched_wall(length, height, openings, width, spring, thickness):
    """A wall along y from 0 to length in the plane x = 0, as thick towards +x, with arched doorways.

    openings: the y of each doorway's middle, ascending; width and spring (height where the arch begins) of each.
    """
    shape = Shape()
    for x, inside in ((0.0, True), (thickness, False)):
        def face(points):
            points = points if inside else points[::-1]
            # Seen from -x, counter-clockwise runs against y.
            shape.face([(x, y, z) for y, z in points[::-1]], points[::-1])
        edges = [0.0] + [middle + side * width / 2.0 for middle in openings for side in (-1, 1)] + [length]
        for left, right in zip(edges[::2], edges[1::2]):
            face([(left, 0.0), (right, 0.0), (right, height), (left, height)])
        for middle in openings:
            points = arch_points(width, spring)
            for (a, za), (b, zb) in zip(points, points[1:]):
                face([(middle + a, za), (middle + b, zb), (middle + b, height), (middle + a, height)])
    for middle in openings:
        outline = [(-width / 2.0, 0.0)] + arch_points(width, spring) + [(width / 2.0, 0.0)]
        along = 0.0
        for (a, za), (b, zb) in zip(outline, outline[1:]):
            step = math.hypot(b - a, zb - za)
            shape.face([(0.0, middle + a, za), (thickness, middle + a, za), (thickness, middle + b, zb), (0.0, middle + b, zb)],
                       [(0.0, along), (thickness, along), (thickness, along + step), (0.0, along + step)])
            along += step
    return shape


def gable(radius, spring, hole_height, hole_radius, segments=96):
    """A wall in the plane y = 0, facing -y, that closes a barrel vault, with one round window.

    radius: half the vault's width; spring: where the vault begins; the window's middle stands at hole_height.
    """
    shape, inner, outer = Shape(), [], []
    for s in range(segments + 1):
        angle = 2.0 * math.pi * s / segments
        across, up = math.cos(angle), math.sin(angle)
        inner.append((hole_radius * across, hole_height + hole_radius * up))
        # The ray from the window's middle ends at a side, at the floor, or at the vault.
        reach = min(radius / abs(across) if abs(across) > 1e-9 else math.inf, hole_height / -up if up < -1e-9 else math.inf)
        if hole_height + reach * up > spring:
            toward, rise = hole_height - spring, up
            reach = -toward * rise + math.sqrt((toward * rise) ** 2 + radius**2 - toward**2)
        outer.append((reach * across, hole_height + reach * up))
    for s in range(segments):
        corners = [inner[s], inner[s + 1], outer[s + 1], outer[s]]
        shape.face([(x, 0.0, z) for x, z in corners], corners)
    # The window's reveal.
    rows = [[(x, depth, z) for x, z in inner] for depth in (0.0, 0.35)]
    shape.grid(rows, [[(s / 16.0, depth) for s in range(segments + 1)] for depth in (0.0, 0.35)])
    return shape


def vault(radius, spring, length, ribs, segments=48):
    """A barrel vault along y with ribs below it at the given y."""
    shape = Shape()
    arc = arch_points(2.0 * radius, spring, segments)
    arc_uv = [math.pi * radius * s / segments for s in range(segments + 1)]
    ends = (0.0, length)
    # Rows run against y so that the faces look down.
    shape.grid([[(x, y, z) for x, z in arc] for y in ends], [[(y, u) for u in arc_uv] for y in ends])
    for middle in ribs:
        low, high = middle - 0.17, middle + 0.17
        thin = arch_points(2.0 * radius - 0.3, spring, segments)
        shape.grid([[(x, y, z) for x, z in thin] for y in (low, high)], [[(y, u) for u in arc_uv] for y in (low, high)])
        for y, first, second in ((low, arc, thin), (high, thin, arc)):
            shape.grid([[(x, y, z) for x, z in row] for row in (first, second)],
                       [[(v, u) for u in arc_uv] for v in (0.0, 0.15)], smooth=False)
    return shape


def curtain(width, height, folds, depth, columns=120):
    """A hanging cloth in the plane x = 0 along y, gathered at the top; UVs 0..1."""
    shape, rows, uvs = Shape(), [], []
    levels = 14
    for level in range(levels + 1):
        t = level / levels
        row, row_uv = [], []
        for column in range(columns + 1):
            s = column / columns
            phase = 2.0 * math.pi * folds * s
            swing = math.sin(phase + 0.5 * math.sin(3.1 * s + 2.0 * t)) + 0.35 * math.sin(2.3 * phase + 1.0)
            # Folds open towards the hem, and the cloth is drawn in by a tie at a third of its height.
            tie = 1.0 - 0.45 * math.exp(-(((t - 0.62) / 0.16) ** 2))
            row.append((depth * (0.35 + 0.65 * t) * swing * (0.6 + 0.4 * tie), width * (0.5 + (s - 0.5) * tie), height * (1.0 - t)))
            row_uv.append((s, 1.0 - t))
        rows.append(row)
        uvs.append(row_uv)
    shape.grid(rows, uvs)
    return shape


def leaf_card(length, width, lift, droop):
    """A leaf that grows from the origin along +x, rises and droops; UVs 0..1 with u along it."""
    shape, steps = Shape(), 6
    spine, rise = [(0.0, 0.0)], lift
    for _ in range(steps):
        spine.append((spine[-1][0] + length / steps * math.cos(rise), spine[-1][1] + length / steps * math.sin(rise)))
        rise -= droop / steps
    rows = [[(x, side * width / 2.0, z + 0.12 * width * abs(side)) for x, z in spine] for side in (-1, 0, 1)]
    shape.grid(rows, [[(s / steps, v) for s in range(steps + 1)] for v in (0.0, 0.5, 1.0)])
    return shape
