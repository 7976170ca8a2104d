# SPDX-License-Identifier: GPL-3.0-or-later
"""What node_atlas.py shows: the cases of each group, and how far each row of the table may be from Cycles.

Needs no Blender; the cases themselves are in node_values.py, node_textures.py and node_shaders.py.
"""

import math
from typing import NamedTuple

import node_shaders
import node_textures
import node_values

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
    "emission": Light(values=False, suns=(SUN,), samples=4),
    "closures": Light(values=False, curved=True, suns=(SUN,), samples=64, panoptes_samples=64),
    "world": Light(values=False, curved=True, world=(0.8, 1.0, 1.2), samples=256, panoptes_samples=64),
}


def cases(group):
    """The cases of a group, in the order of its tiles: rows from the bottom, each from the left."""
    return {"values": node_values.values, "textures": node_textures.textures, "images": node_textures.images,
            "projections": node_textures.boxes, "bump": node_shaders.bumps, "alpha": node_shaders.alpha,
            "emission": node_shaders.emission,
            "closures": node_shaders.closures, "world": node_shaders.closures}[group]()


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
IMAGES = Bound(8e-3, 4e-2, EIGHT_BITS)
DEFAULTS = {"images": IMAGES, "projections": IMAGES, "bump": LIGHT, "emission": LIGHT, "closures": LIGHT,
            "world": Bound(0.02, 0.08, FITTED)}


def bound(group, row):
    """How far a row of a group may be from Cycles."""
    return BOUNDS.get((group, row)) or DEFAULTS.get(group, ROUNDING)
