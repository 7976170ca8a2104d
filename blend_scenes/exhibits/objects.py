# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of geometry: every kind of object, and every way in which a mesh can be out of order."""

import math

import bpy

from exhibits.gallery import above, link, operator_object, thing


def _mesh(name, vertices, faces, *materials):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], faces)
    for one in materials:
        mesh.materials.append(one)
    mesh.update()
    return mesh


def _cube(name, place, material, size=0.5, **settings):
    """A cube of its own mesh that stands on a plinth."""
    half = 0.5 * size
    corners = [(x, y, z) for x in (-half, half) for y in (-half, half) for z in (-half, half)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return thing(name, _mesh(name, corners, faces, material), above(place, half), **settings)


def modified(row, material):
    """Objects that modifiers make."""
    made = _cube("subdivided", row.place(), material)
    made.modifiers.new("bevel", "BEVEL").width = 0.05
    made.modifiers.new("smooth", "SUBSURF").render_levels = 2
    made = _cube("array", above(row.place(), 0.0), material, size=0.12)
    stack = made.modifiers.new("array", "ARRAY")
    stack.count, stack.relative_offset_displace = 5, (0.3, 0.0, 1.1)
    made = thing("screw", _mesh("screw", [(0.1, 0, 0), (0.25, 0, 0), (0.25, 0, 0.1)], [], material), above(row.place(), 0.05))
    made.data.edges.add(2)
    made.data.edges.foreach_set("vertices", [0, 1, 1, 2])
    turn = made.modifiers.new("screw", "SCREW")
    turn.screw_offset, turn.iterations, turn.render_steps = 0.25, 2, 24
    made = _cube("bitten", row.place(), material)
    tool = _cube("tool", made.location, material, size=0.35)
    tool.location = above(made.location, 0.2)
    tool.location.x += 0.2
    tool.hide_render, tool.display_type = True, "WIRE"
    bite = made.modifiers.new("bite", "BOOLEAN")
    bite.object, bite.solver = tool, "FAST"


def moving(row, material):
    """Shape key, armature, lattice: they move from frame to frame."""
    made = _cube("shape key", row.place(), material)
    made.shape_key_add(name="Basis")
    key = made.shape_key_add(name="Top")
    for corner in key.data:
        if corner.co.z > 0.0:
            corner.co.xy *= 0.2
    for frame, value in ((1, 0.2), (3, 1.0)):
        key.value = value
        key.keyframe_insert("value", frame=frame)

    place = row.place()
    rings = [(0.14 * math.cos(a * math.tau / 12), 0.14 * math.sin(a * math.tau / 12), 0.1 * z) for z in range(8) for a in range(12)]
    faces = [(z * 12 + a, z * 12 + (a + 1) % 12, z * 12 + 12 + (a + 1) % 12, z * 12 + 12 + a) for z in range(7) for a in range(12)]
    made = thing("bent", _mesh("bent", rings, faces, material), place)
    bones = thing("bones", bpy.data.armatures.new("bones"), place)
    bpy.context.view_layer.objects.active = bones
    bpy.ops.object.mode_set(mode="EDIT")
    low, high = bones.data.edit_bones.new("low"), bones.data.edit_bones.new("high")
    low.head, low.tail, high.head, high.tail = (0, 0, 0), (0, 0, 0.35), (0, 0, 0.35), (0, 0, 0.7)
    high.parent = low
    bpy.ops.object.mode_set(mode="OBJECT")
    for name, chosen in (("low", range(48)), ("high", range(48, 96))):
        made.vertex_groups.new(name=name).add(list(chosen), 1.0, "REPLACE")
    made.modifiers.new("bones", "ARMATURE").object = bones
    for frame, angle in ((1, 0.2), (3, 0.9)):
        bones.pose.bones["high"].rotation_mode = "XYZ"
        bones.pose.bones["high"].rotation_euler.x = angle
        bones.pose.bones["high"].keyframe_insert("rotation_euler", frame=frame)

    place = row.place()
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3, radius=0.3, location=above(place, 0.3))
    made = bpy.context.object
    made.name = made.data.name = "squeezed"
    made.data.materials.append(material)
    cage = thing("cage", bpy.data.lattices.new("cage"), made.location, scale=(0.7, 0.7, 0.7))
    for point in cage.data.points:
        point.co_deform.x *= 0.5 if point.co.z > 0 else 1.3
    made.modifiers.new("cage", "LATTICE").object = cage


def not_meshes(row, material):
    """Curves, surfaces, text and metaballs, which Blender turns into meshes."""
    place = row.place()
    made = operator_object("curve", above(place, 0.3), bpy.ops.curve.primitive_bezier_circle_add, radius=0.28, rotation=(0.6, 0.3, 0.0))
    made.data.bevel_depth = 0.05
    made.data.materials.append(material)
    letters = bpy.data.curves.new("text", "FONT")
    letters.body, letters.size, letters.extrude, letters.align_x = "Aa", 0.5, 0.05, "CENTER"
    letters.materials.append(material)
    thing("text", letters, above(row.place(), 0.03), rotation_euler=(math.pi / 2, 0.0, 0.2))
    made = operator_object("surface", above(row.place(), 0.28), bpy.ops.surface.primitive_nurbs_surface_sphere_add, radius=0.28)
    made.data.materials.append(material)
    place = row.place()
    balls = bpy.data.metaballs.new("metaball")
    balls.render_resolution, balls.resolution = 0.06, 0.1
    balls.materials.append(material)
    for x, radius in ((-0.12, 0.32), (0.15, 0.26)):
        ball = balls.elements.new()
        ball.co, ball.radius = (x, 0.0, 0.25), radius
    thing("metaball", balls, place)


def instances(row, material, other):
    """Collections, particles and geometry nodes that place objects."""
    pebbles = bpy.data.collections.new("pebbles")
    for x, scale in ((-0.15, 0.12), (0.12, 0.16)):
        bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2, radius=scale, location=(x, 0.0, scale))
        made = bpy.context.object
        made.data.materials.append(material if x < 0 else other)
        bpy.context.scene.collection.objects.unlink(made)
        link(made, pebbles)
    place = row.place()
    group = thing("collection instance", None, place)
    group.instance_type, group.instance_collection = "COLLECTION", pebbles

    place = row.place()
    grain = _cube("grain", above(place, 0.0), other, size=0.25)
    grain.hide_render = True
    ground = thing("emitter", _mesh("emitter", [(-0.3, -0.3, 0), (0.3, -0.3, 0), (0.3, 0.3, 0), (-0.3, 0.3, 0)], [(0, 1, 2, 3)],
                                    material), above(place, 0.01))
    ground.modifiers.new("grains", "PARTICLE_SYSTEM")
    settings = ground.particle_systems[0].settings
    settings.type, settings.count, settings.render_type, settings.instance_object = "HAIR", 40, "OBJECT", grain
    settings.particle_size, settings.hair_length, settings.use_advanced_hair = 1.0, 0.3, True

    place = row.place()
    made = thing("scattered", _mesh("scattered", [(-0.3, -0.3, 0), (0.3, -0.3, 0), (0.3, 0.3, 0), (-0.3, 0.3, 0)], [(0, 1, 2, 3)],
                                    material), above(place, 0.01))
    tree = bpy.data.node_groups.new("scatter", "GeometryNodeTree")
    tree.inputs.new("NodeSocketGeometry", "Geometry")
    tree.outputs.new("NodeSocketGeometry", "Geometry")
    nodes = {kind: tree.nodes.new(kind) for kind in (
        "NodeGroupInput", "GeometryNodeDistributePointsOnFaces", "GeometryNodeInstanceOnPoints", "GeometryNodeMeshCone",
        "GeometryNodeJoinGeometry", "NodeGroupOutput")}
    nodes["GeometryNodeDistributePointsOnFaces"].inputs["Density"].default_value = 90.0
    cone = nodes["GeometryNodeMeshCone"]
    cone.inputs["Vertices"].default_value, cone.inputs["Radius Bottom"].default_value, cone.inputs["Depth"].default_value = 8, 0.04, 0.25
    for start, out, end, into in (
            ("NodeGroupInput", 0, "GeometryNodeDistributePointsOnFaces", "Mesh"),
            ("GeometryNodeDistributePointsOnFaces", "Points", "GeometryNodeInstanceOnPoints", "Points"),
            ("GeometryNodeMeshCone", "Mesh", "GeometryNodeInstanceOnPoints", "Instance"),
            ("GeometryNodeInstanceOnPoints", 0, "GeometryNodeJoinGeometry", "Geometry"),
            ("NodeGroupInput", 0, "GeometryNodeJoinGeometry", "Geometry"),
            ("GeometryNodeJoinGeometry", 0, "NodeGroupOutput", 0)):
        tree.links.new(nodes[start].outputs[out], nodes[end].inputs[into])
    made.modifiers.new("scatter", "NODES").node_group = tree


def meshes(row, materials):
    """What one mesh can carry: materials, UV maps, colours, normals of its own, a mirroring scale."""
    made = _cube("many materials", row.place(), materials[0])
    for one in (*materials[1:], None):
        made.data.materials.append(one)
    # The last face names a slot that does not exist.
    made.data.polygons.foreach_set("material_index", [0, 1, 2, 3, 1, 7])
    for name in ("first", "second"):
        made.data.uv_layers.new(name=name)
    for name, domain in (("corner", "CORNER"), ("point", "POINT")):
        made.data.color_attributes.new(name, "BYTE_COLOR", domain)
    made = _cube("custom normals", row.place(), materials[1])
    made.data.use_auto_smooth = True
    made.data.normals_split_custom_set([v.co.normalized() for v in (made.data.vertices[i] for i in (
        loop.vertex_index for loop in made.data.loops))])
    _cube("mirrored", row.place(), materials[2], scale=(-1.0, 0.8, 1.0), rotation_euler=(0.0, 0.0, 0.5))
    made = _cube("moving", row.place(), materials[0], size=0.4)
    for frame in (1, 3):
        made.rotation_euler.z = 0.4 * frame
        made.keyframe_insert("rotation_euler", frame=frame)


def visibility(row, material):
    """Objects that some rays do not meet, and objects that nobody shall see."""
    for kind in ("camera", "shadow", "diffuse", "glossy"):
        setattr(_cube("no " + kind, row.place(), material, size=0.45), "visible_" + kind, False)
    place = row.place()
    _cube("hidden in renders", place, material).hide_render = True
    _cube("hidden in views", above(place, 0.1), material, size=0.3).hide_viewport = True
    away = bpy.data.collections.new("excluded")
    bpy.context.scene.collection.children.link(away)
    made = _cube("excluded", above(place, 0.2), material)
    bpy.context.scene.collection.objects.unlink(made)
    link(made, away)
    bpy.context.view_layer.layer_collection.children["excluded"].exclude = True


def broken(row, material):
    """Meshes that make no sense."""
    made = _cube("not a number", row.place(), material)
    made.data.vertices[7].co = (math.nan, 0.0, math.inf)
    x, y, z = row.place()
    flat = [(0, 0, 0), (0.3, 0, 0), (0.6, 0, 0), (0.2, 0.2, 0.3), (0.2, 0.2, 0.3), (0, 0, 0.4)]
    thing("no area", _mesh("no area", flat, [(0, 1, 2), (3, 4, 5), (0, 1, 5)], material), (x - 0.2, y, z))
    thing("empty mesh", bpy.data.meshes.new("empty mesh"), (x, y, z))
    edges = bpy.data.meshes.new("edges only")
    edges.from_pydata([(0, 0, 0), (0, 0, 1)], [(0, 1)], [])
    thing("edges only", edges, (x, y, z))
    thing("flattened", bpy.data.meshes["plinth"], (x, y, z), scale=(0.0, 1.0, 1.0))


def not_rendered_yet(row, material):
    """A volume, hair and points, each a sentence to the artist; and a drawing, which Blender adds itself."""
    place = row.place()
    cloud = bpy.data.volumes.new("cloud")
    cloud.materials.append(_fog())
    made = thing("cloud", cloud, above(place, 0.3))
    fill = made.modifiers.new("fill", "MESH_TO_VOLUME")
    fill.object, fill.voxel_amount = bpy.data.objects["squeezed"], 8
    place = row.place()
    bpy.ops.object.curves_random_add(location=place)
    bpy.context.object.name = "hair"
    bpy.context.object.scale = (0.2, 0.2, 0.2)
    operator_object("drawing", above(row.place(), 0.3), bpy.ops.object.gpencil_add, type="STROKE", rotation=(math.pi / 2, 0.0, 0.0))
    bpy.context.object.scale = (0.3, 0.3, 0.3)
    place = row.place()
    made = _cube("points", place, material)
    tree = bpy.data.node_groups.new("points", "GeometryNodeTree")
    tree.inputs.new("NodeSocketGeometry", "Geometry")
    tree.outputs.new("NodeSocketGeometry", "Geometry")
    nodes = [tree.nodes.new(kind) for kind in ("NodeGroupInput", "GeometryNodeMeshToPoints", "NodeGroupOutput")]
    for start, end in zip(nodes, nodes[1:]):
        tree.links.new(start.outputs[0], end.inputs[0])
    made.modifiers.new("points", "NODES").node_group = tree
    fur = _cube("fur", row.place(), material)
    fur.modifiers.new("fur", "PARTICLE_SYSTEM")
    fur.particle_systems[0].settings.type = "HAIR"
    fur.particle_systems[0].settings.count, fur.particle_systems[0].settings.hair_length = 60, 0.25


def _fog():
    made = bpy.data.materials.new("fog")
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    fog, output = tree.nodes.new("ShaderNodeVolumePrincipled"), tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(fog.outputs[0], output.inputs["Volume"])
    return made


def silent():
    """Objects that have no picture: none of them shall matter."""
    for name, operator, settings in (("speaker", bpy.ops.object.speaker_add, {}), ("wind", bpy.ops.object.effector_add, {"type": "WIND"}),
                                     ("probe", bpy.ops.object.lightprobe_add, {"type": "CUBEMAP"})):
        operator(location=(0.0, -1.0, 0.5), **settings)
        bpy.context.object.name = name
    mark = thing("mark", None, (0.0, -1.0, 0.5))
    mark.empty_display_type = "IMAGE"


def furnish(rows, materials):
    """Fills two rows."""
    first, second = rows
    modified(first, materials[0])
    moving(first, materials[1])
    not_meshes(first, materials[2])
    instances(first, materials[0], materials[1])
    meshes(second, materials)
    visibility(second, materials[1])
    broken(second, materials[2])
