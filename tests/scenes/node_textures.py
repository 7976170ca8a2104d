# SPDX-License-Identifier: GPL-3.0-or-later
"""Cases of procedural textures, of images and of environments."""

import numpy as np

from node_values import Case, node, placed


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
