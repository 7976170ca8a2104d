# SPDX-License-Identifier: GPL-3.0-or-later
"""What node_atlas.py shows: the cases of each group, and how far each row of the table may be from Cycles.

Needs no Blender to be read; the functions that build nodes get a node_atlas.Tree.
"""

import math
from typing import Callable, NamedTuple

import numpy as np

# Pixels along a tile, and how values become light.
PIXELS = 16
SCALE, OFFSET = 0.05, 1.0


class Light(NamedTuple):
    """How the tiles of a group are lit: `values` shine by themselves, the others lie on a curved patch."""

    values: bool = True
    curved: bool = False
    world: tuple = (0.0, 0.0, 0.0)
    suns: tuple = ()  # (Euler angles, strength)
    samples: int = 1  # of Cycles
    panoptes_samples: int = 1


class Case(NamedTuple):
    """One tile: `build(tree)` returns the socket that is shown; rows of the table may have several cases."""

    row: str
    name: str
    build: Callable


class Bound(NamedTuple):
    """How far a row may be from Cycles, and why that far: relative RMSE, and the largest error of a pixel."""

    rmse: float
    largest: float
    reason: str


SUN = ((0.5, 0.35, 0.0), 3.0)
GROUPS = {
    "values": Light(),
    "textures": Light(),
    "images": Light(),
    "projections": Light(values=False, curved=True),
    "bump": Light(values=False, curved=True, suns=(SUN,), samples=16),
    "alpha": Light(values=False, curved=True, suns=(SUN,), world=(0.2, 0.3, 0.4), samples=1024, panoptes_samples=64),
    "closures": Light(values=False, curved=True, suns=(SUN,), samples=64, panoptes_samples=64),
    "world": Light(values=False, curved=True, world=(0.8, 1.0, 1.2), samples=256, panoptes_samples=64),
}

# --- values ---------------------------------------------------------------------------------------------

MATH = """ADD SUBTRACT MULTIPLY DIVIDE MULTIPLY_ADD POWER LOGARITHM SQRT INVERSE_SQRT ABSOLUTE EXPONENT MINIMUM MAXIMUM
LESS_THAN GREATER_THAN SIGN COMPARE SMOOTH_MIN SMOOTH_MAX ROUND FLOOR CEIL TRUNC FRACT MODULO WRAP SNAP PINGPONG SINE
COSINE TANGENT ARCSINE ARCCOSINE ARCTANGENT ARCTAN2 SINH COSH TANH RADIANS DEGREES""".split()
VECTOR_MATH = """ADD SUBTRACT MULTIPLY DIVIDE MULTIPLY_ADD CROSS_PRODUCT PROJECT REFLECT REFRACT FACEFORWARD DOT_PRODUCT
DISTANCE LENGTH SCALE NORMALIZE ABSOLUTE MINIMUM MAXIMUM FLOOR CEIL FRACTION MODULO WRAP SNAP SINE COSINE
TANGENT""".split()
BLEND = """MIX DARKEN MULTIPLY BURN LIGHTEN SCREEN DODGE ADD OVERLAY SOFT_LIGHT LINEAR_LIGHT DIFFERENCE SUBTRACT DIVIDE HUE
SATURATION COLOR VALUE""".split()


def node(kind, low=-1.0, high=1.0, output=0, row=None, prepare=None, **settings):
    """A case of one node whose inputs run over low..high; `prepare(tree, node)` may link some before."""

    def build(tree):
        made = tree.add(kind, **settings)
        if prepare:
            prepare(tree, made)
        tree.vary(made, low, high)
        shown = [socket for socket in made.outputs if socket.enabled]
        return shown[output] if isinstance(output, int) else made.outputs[output]

    words = [kind, *map(str, settings.values()), str(output)]
    return Case(row or kind, " ".join(words), build)


def placed(name="Vector", low=0.0, high=1.0):
    """A `prepare` that feeds one input with the place on the tile."""
    return lambda tree, made: tree.link(tree.place(low, high), made.inputs[name])


def ramp(interpolation, mode="RGB"):
    """A Color Ramp of three stops."""

    def prepare(tree, made):
        found = made.color_ramp
        found.color_mode = mode
        setattr(found, "interpolation" if mode == "RGB" else "hue_interpolation", interpolation)
        found.elements[0].color, found.elements[0].position = (1, 0, 0, 1), 0.13
        found.elements.new(0.41).color = (0, 0.5, 1, 0.5)

    return node("ValToRGB", -0.1, 1.1, row="ColorRamp", prepare=prepare)._replace(name=f"ColorRamp {mode} {interpolation}")


def curve(kind):
    """A curve node, bent."""

    def prepare(tree, made):
        for index, found in enumerate(made.mapping.curves):
            found.points.new(0.3, 0.6 - 0.1 * index)
        made.mapping.update()

    return node(kind, -0.2, 1.2, prepare=prepare)


def values():
    """Converters, colours, vectors, and what reads the surface."""
    cases = [node("Math", -2.3, 2.9, operation=operation) for operation in MATH]
    cases.append(node("Math", -2.3, 2.9, operation="SUBTRACT", use_clamp=True))
    cases += [node("VectorMath", -2.3, 2.9, operation=operation) for operation in VECTOR_MATH]
    cases += [node("MixRGB", -0.1, 1.2, blend_type=mode) for mode in BLEND]
    cases += [node("Mix", -0.4, 1.3, data_type="RGBA", blend_type=mode, clamp_factor=False, clamp_result=mode == "ADD")
              for mode in BLEND]
    cases += [node("Mix", -1.1, 2.3, data_type="VECTOR", factor_mode=mode) for mode in ("UNIFORM", "NON_UNIFORM")]
    cases.append(node("Mix", -1.1, 2.3, data_type="FLOAT"))
    for kind in ("LINEAR", "STEPPED", "SMOOTHSTEP", "SMOOTHERSTEP"):
        for data in ("FLOAT", "FLOAT_VECTOR"):
            cases += [node("MapRange", 0.1, 4.1, interpolation_type=kind, data_type=data, clamp=clamp) for clamp in (True, False)]
    cases += [node("Clamp", clamp_type=kind) for kind in ("MINMAX", "RANGE")]
    for mode in ("RGB", "HSV", "HSL"):
        cases += [node("SeparateColor", 0.0, 1.1, output, mode=mode) for output in range(3)]
        cases.append(node("CombineColor", 0.0, 1.1, mode=mode))
    cases += [node(kind, -0.1, 1.1, row=kind) for kind in ("SeparateRGB", "SeparateHSV", "CombineRGB", "CombineHSV")]
    cases += [node(kind) for kind in ("SeparateXYZ", "CombineXYZ")]
    cases += [ramp(kind) for kind in ("LINEAR", "CONSTANT", "EASE", "CARDINAL", "B_SPLINE")]
    cases += [ramp("FAR", "HSV"), ramp("CW", "HSL")]
    cases += [curve("RGBCurve"), curve("VectorCurve"), curve("FloatCurve")]
    cases += [node(kind, -0.1, 1.3) for kind in ("Invert", "Gamma", "BrightContrast", "HueSaturation", "RGBToBW")]
    cases += [node("Blackbody", 700.0, 13000.0), node("Wavelength", 370.0, 790.0)]
    for kind in ("POINT", "TEXTURE", "VECTOR", "NORMAL"):
        cases += [node("Mapping", 0.2, 1.5, vector_type=kind),
                  node("Mapping", 0.2, 1.5, vector_type=kind, prepare=mapping_constants)._replace(name=f"Mapping {kind} constant")]
    for kind in ("AXIS_ANGLE", "X_AXIS", "Y_AXIS", "Z_AXIS", "EULER_XYZ"):
        cases.append(node("VectorRotate", -1.2, 1.3, rotation_type=kind, invert=kind == "Y_AXIS"))
    for kind in ("POINT", "VECTOR", "NORMAL"):
        for start, end in (("OBJECT", "WORLD"), ("WORLD", "OBJECT"), ("CAMERA", "WORLD"), ("WORLD", "CAMERA")):
            cases.append(node("VectorTransform", vector_type=kind, convert_from=start, convert_to=end))
    for output in ("Position", "Normal", "Tangent", "True Normal", "Incoming", "Parametric", "Backfacing"):
        cases.append(node("NewGeometry", output=output, row="Geometry"))
    for output in ("Generated", "Normal", "UV", "Object", "Camera", "Window", "Reflection"):
        cases.append(node("TexCoord", output=output))
    cases += [node("CameraData", output=output) for output in ("View Vector", "View Z Depth", "View Distance")]
    cases.append(node("ObjectInfo", output="Location"))
    cases += [node("Tangent", direction_type="RADIAL", axis=axis) for axis in "XYZ"]
    cases.append(node("Tangent", direction_type="UV_MAP"))
    cases += [node("Fresnel", 1.1, 2.0), node("LayerWeight", 0.1, 0.9, 0), node("LayerWeight", 0.1, 0.9, 1)]
    cases += [node("Normal", output=0), node("Normal", output=1)]
    cases += [node("LightPath", output=output) for output in ("Is Camera Ray", "Ray Depth")]
    cases.append(node("LightFalloff", 1.0, 2.0))
    return cases


def mapping_constants(tree, made):
    """Links the vector alone: all that moves it is constant."""
    tree.link(tree.place(-1.1, 1.4), made.inputs["Vector"])
    for name, numbers in (("Location", (0.3, -0.2, 0.5)), ("Rotation", (0.4, 0.9, -0.3)), ("Scale", (1.4, 0.7, -1.2))):
        if made.inputs[name].enabled:
            made.inputs[name].default_value = numbers


# --- procedural textures --------------------------------------------------------------------------------


def textures():
    """Textures that are computed from a place."""
    at = placed(low=-1.7, high=2.1)
    cases = [node("TexChecker", 0.1, 1.0, output, prepare=scaled(at, 2.9)) for output in (0, 1)]
    for kind in ("LINEAR", "QUADRATIC", "EASING", "DIAGONAL", "SPHERICAL", "QUADRATIC_SPHERE", "RADIAL"):
        cases.append(node("TexGradient", prepare=placed(low=-0.9, high=1.1), gradient_type=kind))
    for size in ("1D", "2D", "3D", "4D"):
        cases += [noisy("TexNoise", size, output=output, Detail=2.4, Distortion=distortion, Scale=1.3)
                  for output, distortion in ((0, 0.0), (1, 0.7))]
        cases += [noisy("TexWhiteNoise", size, output=output) for output in (0, 1)]
        cases += [noisy("TexVoronoi", size, output=output, feature=feature, Scale=1.7, Randomness=0.9)
                  for feature in ("F1", "F2", "SMOOTH_F1") for output in range(3)]
        cases += [noisy("TexVoronoi", size, feature=feature, Scale=1.7) for feature in ("DISTANCE_TO_EDGE", "N_SPHERE_RADIUS")]
    cases += [noisy("TexVoronoi", "3D", distance=kind, Scale=1.7) for kind in ("MANHATTAN", "CHEBYCHEV", "MINKOWSKI")]
    cases += [noisy("TexVoronoi", size, output=output, Scale=1.7)
              for size, output in (("1D", "W"), ("4D", "W"))]
    cases += [noisy("TexMusgrave", size, musgrave_type=kind, Detail=3.6, Scale=1.3, Offset=0.8, Gain=1.4)
              for size in ("1D", "2D", "3D", "4D")
              for kind in ("FBM", "MULTIFRACTAL", "HETERO_TERRAIN", "HYBRID_MULTIFRACTAL", "RIDGED_MULTIFRACTAL")]
    for kind, directions in (("BANDS", ("X", "Y", "Z", "DIAGONAL")), ("RINGS", ("X", "Y", "Z", "SPHERICAL"))):
        cases += [noisy("TexWave", wave_type=kind, Scale=0.3, Distortion=0.7 if direction == "Z" else 0.0,
                        **{f"{kind.lower()}_direction": direction}) for direction in directions]
    cases += [noisy("TexWave", wave_profile=kind, Scale=0.3) for kind in ("SAW", "TRI")]
    cases += [noisy("TexMagic", output=depth % 2, turbulence_depth=depth, Scale=0.4, Distortion=1.2) for depth in range(0, 11)]
    cases += [noisy("TexBrick", output=output, Scale=1.3, Mortar_Size=0.1, Mortar_Smooth=0.4, Bias=0.1, squash=1.4)
              for output in (0, 1)]
    return cases


def noisy(kind, size=None, output=0, low=-1.73, high=2.11, **settings):
    """A texture over a place that varies in all components; `settings` are properties or inputs."""

    def build(tree):
        made = tree.add(kind)
        for name in ("noise_dimensions", "musgrave_dimensions", "voronoi_dimensions"):
            if size and hasattr(made, name):
                setattr(made, name, size)
        for key, value in settings.items():
            if hasattr(made, key):
                setattr(made, key, value)
        for key, value in settings.items():
            if not hasattr(made, key):
                made.inputs[key.replace("_", " ")].default_value = value
        def place(turn):
            # White noise is another for every bit: at whole numbers both engines have the same bits.
            where, whole = tree.place(low, high, turn), tree.add("VectorMath", operation="FLOOR")
            tree.link(where, whole.inputs[0])
            return whole.outputs[0] if kind == "TexWhiteNoise" else where

        if size != "1D":
            tree.link(place(0), made.inputs["Vector"])
        if size in ("1D", "4D"):
            tree.link(tree.component(place(1), 2), made.inputs["W"])
        return [socket for socket in made.outputs if socket.enabled][output] if isinstance(output, int) else made.outputs[output]

    words = [kind, str(size), str(output), *(f"{key}={value}" for key, value in settings.items())]
    return Case(kind, " ".join(words), build)


def scaled(prepare, scale):
    """A `prepare` that also sets the input Scale."""

    def both(tree, made):
        prepare(tree, made)
        made.inputs["Scale"].default_value = scale

    return both


# --- images ---------------------------------------------------------------------------------------------


def picture(size=8, seed=3, alpha=False):
    """Random pixels, float[size, size, 4]; in range 0..1, without alpha unless asked for."""
    pixels = np.random.default_rng(seed).random((size, size, 4))
    if not alpha:
        pixels[..., 3] = 1.0
    return pixels


def image_case(row, place=None, output="Color", low=-0.3, high=1.4, pixels=None, kind="TexImage", **settings):
    """A case of an image node; `place(tree)` gives its vector, by default one that runs over low..high."""
    stored = {key: settings.pop(key) for key in ("colorspace", "floats", "alpha_mode") if key in settings}
    mode = stored.pop("alpha_mode", None)

    def build(tree):
        made = tree.add(kind, **settings)
        made.image = tree.image(picture() if pixels is None else pixels, row, **stored)
        if mode:
            made.image.alpha_mode = mode
        tree.link(place(tree) if place else tree.place(low, high), made.inputs["Vector"])
        return made.outputs[output]

    return Case(row, f"{row} {settings} {stored} {mode} {output}", build)


def around(tree):
    """Vectors in all directions, of a length near 1."""
    return tree.place(-1.1, 1.2, 1)


def on_sphere(tree):
    """Vectors over the unit cube, as generated coordinates have them."""
    return tree.place(0.03, 0.98, 1)


def images():
    """Image Texture and Environment Texture."""
    cases = [image_case(f"extension {kind}", extension=kind, interpolation=how)
             for kind in ("REPEAT", "EXTEND", "CLIP") for how in ("Linear", "Closest", "Cubic")]
    cases += [image_case(f"interpolation {kind}", interpolation=kind) for kind in ("Linear", "Closest", "Cubic", "Smart")]
    cases += [image_case(f"colour space {kind}", colorspace=kind) for kind in ("sRGB", "Non-Color", "Linear", "Raw")]
    cases += [image_case("float image", colorspace=kind, floats=True, pixels=picture() * 3.0) for kind in ("Linear", "Non-Color")]
    for mode in ("STRAIGHT", "CHANNEL_PACKED", "NONE"):
        cases += [image_case(f"alpha {mode}", output=output, pixels=picture(alpha=True), alpha_mode=mode)
                  for output in ("Color", "Alpha")]
    cases += [image_case("projection SPHERE", on_sphere, projection="SPHERE"),
              image_case("projection TUBE", on_sphere, projection="TUBE")]
    cases += [image_case(f"environment {kind}", around, kind="TexEnvironment", projection=kind)
              for kind in ("EQUIRECTANGULAR", "MIRROR_BALL")]
    cases.append(image_case("environment cubic", around, kind="TexEnvironment", interpolation="Cubic"))
    return cases


def boxes():
    """Box projection, which follows the normal of a curved surface; colours shine as they are."""

    def shining(blend):
        def build(tree):
            made, shine = tree.add("TexImage", projection="BOX", projection_blend=blend), tree.add("Emission")
            made.image = tree.image(picture(), "box")
            tree.link(tree.add("TexCoord").outputs["Object"], made.inputs["Vector"])
            tree.link(made.outputs["Color"], shine.inputs["Color"])
            return shine.outputs[0]

        return Case("projection BOX", f"projection BOX {blend}", build)

    return [shining(blend) for blend in (0.0, 0.2, 0.7, 1.0)]


# --- shaders --------------------------------------------------------------------------------------------


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
    cases.append(shader("Emission", Color=ORANGE, Strength=2.0))
    cases += [shader("BsdfVelvet", Color=ORANGE, Sigma=sigma) for sigma in (0.4, 1.0)]
    cases += [shader("BsdfGlass", distribution="GGX", Color=ORANGE, Roughness=0.3, IOR=1.45),
              shader("BsdfRefraction", distribution="GGX", Color=ORANGE, Roughness=0.3, IOR=1.45)]
    cases += [mixed("BsdfDiffuse", "BsdfGlossy", 0.3), mixed("BsdfDiffuse", "Emission", 0.3), added()]
    return cases


def alpha():
    """What lets light straight through."""
    return [shader("BsdfTransparent", Color=(0.6, 0.6, 0.6, 1.0)), shader("BsdfTransparent", "tinted Transparent", Color=ORANGE),
            mixed("BsdfTransparent", "BsdfDiffuse", 0.6),
            shader("BsdfPrincipled", "Principled Alpha", Base_Color=ORANGE, Alpha=0.4)]


def bumped(row, low=0.0, high=1.0, invert=False, **inputs):
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
    ("Emission", {"Emission": ORANGE, "Emission_Strength": 1.5}),
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


# --- all ------------------------------------------------------------------------------------------------


def cases(group):
    """The cases of a group, in the order of its tiles: rows from the bottom, each from the left."""
    return {"values": values, "textures": textures, "images": images, "projections": boxes, "bump": bumps, "alpha": alpha,
            "closures": closures, "world": closures}[group]()


def side(count):
    """How many tiles a row of the picture has."""
    return math.ceil(math.sqrt(count))


# Where a row may be further from Cycles than rounding, and why.
HALF = "what a surface is, is kept in half floats"
EIGHT_BITS = "llvmpipe filters 8-bit images in 8 bits"
FITTED = "the world's light by lobe is a fit"
ROUNDING, LIGHT = Bound(1e-3, 5e-3, ""), Bound(2e-3, 1.5e-2, HALF)
BOUNDS = {
    ("values", "LightFalloff"): Bound(0.05, 0.1, "replaced by the strength alone"),
    ("images", "alpha STRAIGHT"): Bound(3e-2, 0.1, "colours are multiplied by alpha in 8 bits"),
    ("images", "projection SPHERE"): Bound(3e-2, 0.4, "one pixel lies on the seam; " + EIGHT_BITS),
    ("images", "projection TUBE"): Bound(3e-2, 0.4, "one pixel lies on the seam; " + EIGHT_BITS),
    ("bump", "Normal Map"): Bound(1.5e-2, 0.2, "normals below the horizon are turned up, at the limit of precision"),
    ("closures", "BsdfGlossy"): Bound(1.5e-2, 0.1, "masking is correlated, as in Cycles since 3.5; here it is separable"),
    ("closures", "MixShader"): Bound(6e-3, 0.08, "half a highlight is one pixel; " + HALF),
    ("closures", "Principled Subsurface"): Bound(0.15, 0.5, "light leaves where it enters"),
    ("closures", "Principled Anisotropic"): Bound(0.06, 0.2, "the highlight is round"),
    ("world", "Principled Subsurface"): Bound(0.1, 0.3, "light leaves where it enters"),
    ("world", "Principled Clearcoat"): Bound(0.06, 0.12, FITTED),
    ("world", "BsdfVelvet"): Bound(0.05, 0.15, FITTED),
    ("alpha", "tinted Transparent"): Bound(0.8, 1.6, "what shows through is grey until rays are traced"),
    ("alpha", "BsdfTransparent"): Bound(0.04, 0.3, "alpha is a coin thrown once a sample"),
    ("alpha", "MixShader"): Bound(0.02, 0.15, "alpha is a coin thrown once a sample"),
    ("alpha", "Principled Alpha"): Bound(0.03, 0.25, "alpha is a coin thrown once a sample"),
}
DEFAULTS = {"images": Bound(8e-3, 4e-2, EIGHT_BITS), "projections": Bound(8e-3, 4e-2, EIGHT_BITS), "bump": LIGHT, "closures": LIGHT,
            "world": Bound(0.02, 0.08, FITTED)}


def bound(group, row):
    """How far a row of a group may be from Cycles."""
    return BOUNDS.get((group, row)) or DEFAULTS.get(group, ROUNDING)
