# SPDX-License-Identifier: GPL-3.0-or-later
"""Cases of nodes that compute numbers, vectors and colours, and of those that read the surface.

The functions that build nodes get a node_atlas.Tree; importing this needs no Blender.
"""

from typing import Callable, NamedTuple


class Case(NamedTuple):
    """One tile: `build(tree)` returns the socket that is shown; rows of the table may have several cases."""

    row: str
    name: str
    build: Callable


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
