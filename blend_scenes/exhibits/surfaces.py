# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of materials: every closure, and every texture and value node that artists use daily.

All spheres share one mesh: each object brings its own material.
"""

import bpy

import textures
from exhibits.gallery import above, thing


def _socket(sockets, name):
    """A socket by index or name; among several of a name the one in use."""
    if isinstance(name, int):
        return sockets[name]
    return next((s for s in sockets if s.name == name and s.enabled), None) or sockets[name]


class Tree:
    """A node tree under construction."""

    def __init__(self, tree):
        self.tree = tree
        self.displacement = None
        tree.nodes.clear()

    def add(self, kind, settings=None, **inputs):
        """Adds a node; inputs by name with _ for spaces: an output socket is linked, a value is set."""
        node = self.tree.nodes.new("ShaderNode" + kind)
        for key, value in (settings or {}).items():
            setattr(node, key, value)
        for key, value in inputs.items():
            self.feed(_socket(node.inputs, key.replace("_", " ")), value)
        return node

    def feed(self, socket, value):
        """Links a socket or sets its value."""
        if isinstance(value, bpy.types.NodeSocket):
            self.tree.links.new(value, socket)
        elif isinstance(value, bpy.types.Node):
            self.tree.links.new(value.outputs[0], socket)
        elif socket.type == "RGBA" and len(value) == 3:
            socket.default_value = (*value, 1.0)
        else:
            socket.default_value = value


def material(name, build):
    """A material whose surface is what `build(tree)` returns: a shader node or a colour node."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    tree = Tree(made.node_tree)
    found = build(tree)
    out = found.outputs[0] if isinstance(found, bpy.types.Node) else found
    if out.type != "SHADER":
        out = tree.add("BsdfPrincipled", Base_Color=out, Roughness=0.5).outputs[0]
    output = tree.add("OutputMaterial", Surface=out)
    if tree.displacement is not None:
        tree.feed(output.inputs["Displacement"], tree.displacement)
    return made


def sphere_mesh():
    """A smooth sphere with UVs and a slot that objects fill."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=32, ring_count=16, radius=0.36)
    made = bpy.context.object
    mesh = made.data
    mesh.name = "sphere"
    mesh.materials.append(None)
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    colors = mesh.color_attributes.new("Paint", "FLOAT_COLOR", "POINT")
    for vertex, paint in zip(mesh.vertices, colors.data):
        paint.color = (*(0.5 + 1.2 * c for c in vertex.co), 1.0)
    bpy.data.objects.remove(made)
    return mesh


def show(row, mesh, name, build):
    """Puts a sphere of a material on the next plinth of a row."""
    made = thing(name, mesh, above(row.place(), 0.36))
    made.material_slots[0].link = "OBJECT"
    made.material_slots[0].material = material(name, build)
    return made


RED, BLUE, GREEN, GOLD, CREAM = ((0.7, 0.08, 0.05), (0.06, 0.15, 0.6), (0.08, 0.45, 0.12), (1.0, 0.71, 0.29),
                                 (0.85, 0.78, 0.65))


def closures():
    """(name, build) of every closure."""
    def bsdf(kind, settings=None, **inputs):
        return kind, lambda tree: tree.add(kind, settings, **inputs)

    def principled(name, **inputs):
        return name, lambda tree: tree.add("BsdfPrincipled", **inputs)

    def mix(tree):
        node = tree.add("MixShader", Fac=tree.add("LayerWeight", Blend=0.3).outputs["Facing"])
        tree.feed(node.inputs[1], tree.add("BsdfDiffuse", Color=RED))
        tree.feed(node.inputs[2], tree.add("BsdfGlossy", Color=CREAM, Roughness=0.2))
        return node

    def add(tree):
        node = tree.add("AddShader")
        tree.feed(node.inputs[0], tree.add("BsdfDiffuse", Color=BLUE))
        tree.feed(node.inputs[1], tree.add("Emission", Color=RED, Strength=0.2))
        return node

    def veil(tree):
        node = tree.add("MixShader", Fac=0.5)
        tree.feed(node.inputs[1], tree.add("BsdfTransparent"))
        tree.feed(node.inputs[2], tree.add("BsdfDiffuse", Color=GREEN))
        return node

    return [
        principled("plastic", Base_Color=RED, Roughness=0.25),
        principled("gold", Base_Color=GOLD, Metallic=1.0, Roughness=0.25),
        principled("chrome", Base_Color=(0.9, 0.9, 0.9), Metallic=1.0, Roughness=0.02),
        principled("principled glass", Base_Color=(0.9, 1.0, 0.95), Transmission=1.0, Roughness=0.0, IOR=1.45),
        principled("car paint", Base_Color=BLUE, Clearcoat=1.0, Clearcoat_Roughness=0.03, Roughness=0.5, Metallic=0.4),
        principled("velvet cloth", Base_Color=(0.25, 0.02, 0.2), Sheen=1.0, Roughness=0.9),
        principled("skin", Base_Color=(0.8, 0.5, 0.4), Subsurface=0.3, Subsurface_Color=(0.9, 0.2, 0.1)),
        principled("ghost", Base_Color=CREAM, Alpha=0.4),
        principled("lantern", Base_Color=(0.1, 0.1, 0.1), Emission=(1.0, 0.55, 0.2), Emission_Strength=3.0),
        ("mix", mix), ("add", add), ("veil", veil),
        bsdf("BsdfDiffuse", Color=GREEN, Roughness=1.0),
        bsdf("BsdfGlossy", Color=GOLD, Roughness=0.1),
    ], [
        bsdf("BsdfGlass", Color=(0.95, 0.98, 1.0), IOR=1.5),
        bsdf("BsdfRefraction", Color=(1.0, 0.9, 0.8), IOR=1.3, Roughness=0.1),
        bsdf("BsdfTranslucent", Color=GREEN),
        bsdf("BsdfTransparent", Color=(0.6, 0.8, 1.0)),
        bsdf("BsdfAnisotropic", Color=CREAM, Roughness=0.3, Anisotropy=0.8),
        bsdf("BsdfToon", Color=RED, Size=0.6),
        bsdf("BsdfVelvet", Color=BLUE),
        bsdf("BsdfHair", Color=GOLD),
        bsdf("BsdfHairPrincipled", Color=(0.3, 0.12, 0.05)),
        bsdf("SubsurfaceScattering", Color=CREAM),
        bsdf("Emission", Color=(0.3, 0.6, 1.0), Strength=2.0),
        bsdf("Holdout"),
        bsdf("EeveeSpecular", Base_Color=RED),
        ("nothing", lambda tree: tree.add("AddShader")),
    ]


def _image(name, maker, data=False):
    return lambda tree: tree.add("TexImage", {"image": textures.packed(name, maker(), data)})


def _missing(tree):
    image = bpy.data.images.new("lost", 8, 8)
    image.source, image.filepath = "FILE", "//lost.png"
    return tree.add("TexImage", {"image": image})


def _ramp(tree):
    node = tree.add("ValToRGB", Fac=tree.add("TexNoise", Scale=5.0).outputs["Fac"])
    node.color_ramp.elements[0].color, node.color_ramp.elements[1].color = (*BLUE, 1.0), (*GOLD, 1.0)
    node.color_ramp.elements.new(0.5).color = (*RED, 1.0)
    return node


def _curves(tree):
    node = tree.add("RGBCurve", Color=tree.add("TexMagic", Scale=3.0).outputs["Color"])
    node.mapping.curves[3].points.new(0.4, 0.7)
    node.mapping.update()
    return node


def _bump(tree):
    bump = tree.add("Bump", Height=tree.add("TexVoronoi", Scale=8.0).outputs["Distance"], Strength=0.8)
    return tree.add("BsdfPrincipled", Base_Color=CREAM, Roughness=0.3, Normal=bump)


def _normal_map(tree):
    image = textures.packed("tile normals", textures.normals(textures.tile_height(64, 4), 3.0), data=True)
    color = tree.add("TexImage", {"image": image}).outputs["Color"]
    return tree.add("BsdfPrincipled", Base_Color=RED, Roughness=0.3, Normal=tree.add("NormalMap", Color=color))


def _group(tree):
    group = bpy.data.node_groups.new("swap", "ShaderNodeTree")
    group.inputs.new("NodeSocketColor", "Color")
    group.outputs.new("NodeSocketColor", "Color")
    inside, outside = (group.nodes.new("NodeGroup" + end) for end in ("Input", "Output"))
    invert = group.nodes.new("ShaderNodeInvert")
    group.links.new(inside.outputs[0], invert.inputs["Color"])
    group.links.new(invert.outputs[0], outside.inputs[0])
    node = tree.add("Group", {"node_tree": group})
    tree.feed(node.inputs[0], tree.add("TexChecker", Scale=6.0, Color1=RED, Color2=CREAM).outputs["Color"])
    return node


def _arithmetic(tree):
    """A chain through the converters."""
    parts = tree.add("SeparateXYZ", Vector=tree.add("TexCoord").outputs["Generated"])
    wave = tree.add("Math", {"operation": "SINE"})
    tree.feed(wave.inputs[0], tree.add("MapRange", Value=parts.outputs[2], To_Max=40.0))
    bright = tree.add("Clamp", Value=wave)
    hue = tree.add("CombineColor", {"mode": "HSV"}, Red=parts.outputs[0], Green=0.8, Blue=bright)
    spun = tree.add("VectorRotate", Vector=hue.outputs[0], Angle=0.4)
    back = tree.add("HueSaturation", Color=tree.add("Gamma", Color=spun, Gamma=0.8), Saturation=1.1)
    return tree.add("BrightContrast", Color=back, Bright=0.1)


def _displaced(tree):
    tree.displacement = tree.add("Displacement", Height=tree.add("TexNoise").outputs["Fac"])
    return tree.add("BsdfDiffuse", Color=CREAM)


def patterns():
    """(name, build) of textures and inputs, in two rows."""
    def texture(kind, output=0, settings=None, **inputs):
        return kind, lambda tree: tree.add("Tex" + kind, settings, **inputs).outputs[output]

    def source(kind, output=0, settings=None, **inputs):
        return kind, lambda tree: tree.add(kind, settings, **inputs).outputs[output]

    def sky(tree):
        return tree.add("TexEnvironment", {"image": bpy.data.images["horizon"]})

    return [
        texture("Noise", 1, Scale=4.0), texture("Voronoi", 1, Scale=6.0), texture("Musgrave", Scale=4.0),
        texture("Wave", Scale=3.0, Distortion=2.0), texture("Magic", Scale=3.0),
        texture("Brick", Scale=4.0, Color1=RED, Color2=(0.5, 0.2, 0.1)), texture("Checker", Scale=6.0, Color1=BLUE),
        texture("Gradient", settings={"gradient_type": "SPHERICAL"}), texture("WhiteNoise", 1),
        ("tiles", _image("tiles", lambda: textures.tiles(128))), ("environment", sky), ("lost", _missing),
        ("ramp", _ramp), ("curves", _curves),
    ], [
        ("bump", _bump), ("normal map", _normal_map), ("group", _group), ("arithmetic", _arithmetic),
        ("displaced", _displaced), source("VertexColor", settings={"layer_name": "Paint"}),
        source("Attribute", settings={"attribute_name": "nowhere"}), source("AmbientOcclusion", Color=CREAM),
        source("Wireframe", Size=0.02), source("ObjectInfo", 1), source("NewGeometry", 1), source("Blackbody", Temperature=3000.0),
        ("point density", lambda tree: tree.add("TexPointDensity")), source("Wavelength", Wavelength=580.0),
    ]


def cut_out(row):
    """A leaf whose alpha comes from an image."""
    def build(tree):
        image = tree.add("TexImage", {"image": textures.packed("leaf", textures.leaf(64)), "extension": "CLIP"})
        return tree.add("BsdfPrincipled", Base_Color=image.outputs["Color"], Alpha=image.outputs["Alpha"])

    bpy.ops.mesh.primitive_plane_add(size=0.8, location=above(row.place(), 0.45), rotation=(1.2, 0.0, 0.3))
    made = bpy.context.object
    made.name = made.data.name = "leaf"
    made.data.materials.append(material("leaf", build))
