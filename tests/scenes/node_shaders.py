# SPDX-License-Identifier: GPL-3.0-or-later
"""Cases of shaders, and of the normals that they are given."""

from node_values import Case


def shader(kind, row=None, prepare=None, name=None, **inputs):
    """A case of one shader node; `inputs` by name, with _ for spaces."""

    def build(tree):
        made = tree.add(kind)
        for key, value in inputs.items():
            if hasattr(made, key):
                setattr(made, key, value)
            else:
                made.inputs[key.replace("_", " ")].default_value = value
        if prepare:
            prepare(tree, made)
        return made.outputs[0]

    return Case(row or kind, name or f"{kind} {inputs}", build)


ORANGE = (0.8, 0.4, 0.15, 1.0)


def closures():
    """Shaders under one sun, or one world: the same for both."""
    cases = [shader("BsdfDiffuse", Color=ORANGE, Roughness=roughness) for roughness in (0.0, 0.4, 1.0)]
    cases += [shader("BsdfGlossy", distribution="GGX", Color=ORANGE, Roughness=roughness) for roughness in (0.2, 0.5, 0.9)]
    cases += [shader("BsdfPrincipled", f"Principled {row}", **{"Base_Color": ORANGE, **inputs}) for row, inputs in PRINCIPLED]
    cases += [shader("BsdfVelvet", Color=ORANGE, Sigma=sigma) for sigma in (0.4, 1.0)]
    cases += [shader("BsdfGlass", distribution="GGX", Color=ORANGE, Roughness=0.3, IOR=1.45),
              shader("BsdfRefraction", distribution="GGX", Color=ORANGE, Roughness=0.3, IOR=1.45)]
    cases.append(mixed("BsdfDiffuse", "BsdfGlossy", 0.3))
    return cases


def emission():
    """What shines, on flat tiles: they do not light each other."""
    return [shader("Emission", Color=ORANGE, Strength=2.0),
            shader("BsdfPrincipled", "Principled Emission", Base_Color=ORANGE, Emission=ORANGE, Emission_Strength=1.5),
            mixed("BsdfDiffuse", "Emission", 0.3), added()]


def alpha():
    """What lets light straight through."""
    return [shader("BsdfTransparent", Color=(0.6, 0.6, 0.6, 1.0)), shader("BsdfTransparent", "tinted Transparent", Color=ORANGE),
            mixed("BsdfTransparent", "BsdfDiffuse", 0.6),
            shader("BsdfPrincipled", "Principled Alpha", Base_Color=ORANGE, Alpha=0.4)]


def bumped(row, invert=False, **inputs):
    """A diffuse surface whose normal is a Bump node's over a wavy height."""

    def build(tree):
        made, surface = tree.add("Bump", invert=invert), tree.add("BsdfDiffuse")
        for key, value in inputs.items():
            made.inputs[key].default_value = value
        tree.link(waves(tree), made.inputs["Height"])
        tree.link(made.outputs[0], surface.inputs["Normal"])
        return surface.outputs[0]

    return Case(row, f"{row} {invert} {inputs}", build)


def waves(tree):
    """A height that waves over the surface's place."""
    made, product = tree.add("VectorMath", operation="SINE"), tree.add("VectorMath", operation="DOT_PRODUCT")
    product.inputs[1].default_value = (0.05, 0.05, 0.05)
    tree.link(tree.place(0.0, 11.0), made.inputs[0])
    tree.link(made.outputs[0], product.inputs[0])
    return product.outputs["Value"]


def displaced(tree, space="OBJECT"):
    """A Displacement node on the output, drawn as bumps."""
    made, surface = tree.add("Displacement", space=space), tree.add("BsdfDiffuse")
    made.inputs["Scale"].default_value = 0.7
    tree.link(waves(tree), made.inputs["Height"])
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    tree.link(made.outputs[0], output.inputs["Displacement"])
    return surface.outputs[0]


def twice_bumped(tree):
    """A Bump node that starts from another's normal."""
    first, second, surface = tree.add("Bump"), tree.add("Bump"), tree.add("BsdfDiffuse")
    tree.link(waves(tree), first.inputs["Height"])
    tree.link(tree.component(tree.place(0.0, 0.4, 1), 2), second.inputs["Height"])
    tree.link(first.outputs[0], second.inputs["Normal"])
    tree.link(second.outputs[0], surface.inputs["Normal"])
    return surface.outputs[0]


def coat_bumped(tree):
    """A clear coat with a normal of its own."""
    made, surface = tree.add("Bump"), tree.add("BsdfPrincipled")
    surface.inputs["Clearcoat"].default_value, surface.inputs["Clearcoat Roughness"].default_value = 1.0, 0.3
    tree.link(waves(tree), made.inputs["Height"])
    tree.link(made.outputs[0], surface.inputs["Clearcoat Normal"])
    return surface.outputs[0]


def normal_mapped(space, strength=1.0):
    """A Normal Map node that reads a colour which varies over the surface."""

    def build(tree):
        made, surface = tree.add("NormalMap", space=space, uv_map="UVMap"), tree.add("BsdfDiffuse")
        made.inputs["Strength"].default_value = strength
        tree.link(tree.place(0.35, 0.8, 1), made.inputs["Color"])
        tree.link(made.outputs[0], surface.inputs["Normal"])
        return surface.outputs[0]

    return Case("Normal Map", f"Normal Map {space} {strength}", build)


def bumps():
    """Normals from heights and from maps."""
    return [normal_mapped("TANGENT"), normal_mapped("TANGENT", 0.4), normal_mapped("OBJECT"), normal_mapped("WORLD"),
            normal_mapped("BLENDER_OBJECT"), normal_mapped("BLENDER_WORLD"),
            bumped("Bump"), bumped("Bump", Strength=0.4), bumped("Bump", Distance=0.3), bumped("Bump", invert=True),
            Case("Bump on Bump", "Bump on Bump", twice_bumped), Case("Displacement", "Displacement", displaced),
            Case("Displacement", "Displacement WORLD", lambda tree: displaced(tree, "WORLD")),
            Case("Clearcoat Normal", "Clearcoat Normal", coat_bumped)]


PRINCIPLED = [
    ("Base Color", {}), ("Base Color", {"Base_Color": (0.1, 0.2, 0.9, 1.0)}),
    ("Roughness", {"Roughness": 0.1}), ("Roughness", {"Roughness": 0.3}), ("Roughness", {"Roughness": 1.0}),
    ("Specular", {"Specular": 0.0}), ("Specular", {"Specular": 1.0}), ("Specular Tint", {"Specular": 1.0, "Specular_Tint": 1.0}),
    ("Metallic", {"Metallic": 0.5}), ("Metallic", {"Metallic": 1.0}),
    ("Sheen", {"Sheen": 1.0, "Sheen_Tint": 0.0}), ("Sheen Tint", {"Sheen": 1.0, "Sheen_Tint": 1.0}),
    ("Clearcoat", {"Clearcoat": 1.0}), ("Clearcoat Roughness", {"Clearcoat": 1.0, "Clearcoat_Roughness": 0.4}),
    ("Transmission", {"Transmission": 0.5}), ("Transmission", {"Transmission": 1.0}), ("IOR", {"Transmission": 0.5, "IOR": 2.0}),
    ("Subsurface", {"Subsurface": 0.5, "Subsurface_Color": (0.9, 0.1, 0.1, 1.0)}), ("Anisotropic", {"Anisotropic": 0.7}),
]


def mixed(first, second, factor):
    """Mix Shader of two shaders."""

    def build(tree):
        made = tree.add("MixShader")
        made.inputs[0].default_value = factor
        for kind, socket in ((first, made.inputs[1]), (second, made.inputs[2])):
            part = tree.add(kind)
            if kind == "BsdfGlossy":
                part.distribution = "GGX"
                part.inputs["Roughness"].default_value = 0.3
            tree.link(part.outputs[0], socket)
        return made.outputs[0]

    return Case("MixShader", f"MixShader {first} {second}", build)


def added():
    """Add Shader of diffuse and emission."""

    def build(tree):
        made = tree.add("AddShader")
        for kind, socket in (("BsdfDiffuse", made.inputs[0]), ("Emission", made.inputs[1])):
            tree.link(tree.add(kind).outputs[0], socket)
        return made.outputs[0]

    return Case("AddShader", "AddShader", build)
