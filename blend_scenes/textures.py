# SPDX-License-Identifier: GPL-3.0-or-later
"""Small images for our own scenes, computed with numpy and packed into the .blend.

Each function returns float32[N, N, 4] with row 0 at the bottom, as Blender stores pixels: colours
sRGB-encoded 0..1, alpha straight.
"""

import bpy
import numpy as np


def noise(size, cells, seed):
    """Smooth value noise 0..1 that repeats at the border, from a lattice of cells x cells random values."""
    lattice = np.random.default_rng(seed).random((cells, cells))
    at = np.arange(size) * cells / size
    low = at.astype(int)
    part = at - low
    part = part * part * (3.0 - 2.0 * part)
    high = (low + 1) % cells
    rows = lattice[low] * (1.0 - part[:, None]) + lattice[high] * part[:, None]
    return rows[:, low] * (1.0 - part) + rows[:, high] * part


def clouds(size, seed):
    """Three octaves of noise, 0..1."""
    return (4.0 * noise(size, 4, seed) + 2.0 * noise(size, 8, seed + 1) + noise(size, 16, seed + 2)) / 7.0


def opaque(colour):
    """Adds an alpha of 1 to float[N, N, 3]."""
    return np.concatenate([colour, np.ones((*colour.shape[:2], 1))], axis=2).astype(np.float32)


def tile_height(size, tiles=4):
    """The height 0..1 of a floor of square tiles with rounded edges."""
    place = (np.arange(size) + 0.5) / size * tiles % 1.0
    edge = np.minimum(place, 1.0 - place)
    ramp = np.clip((edge - 0.02) / 0.07, 0.0, 1.0)
    ramp = ramp * ramp * (3.0 - 2.0 * ramp)
    return np.minimum(ramp[:, None], ramp[None, :])


def tiles(size=256, count=4):
    """Terracotta and cream tiles in a chequer, each a little different, with grey joints."""
    index = np.arange(size) * count // size
    chequer = (index[:, None] + index[None, :]) % 2
    own = np.random.default_rng(7).random((count, count))[index[:, None], index[None, :]]
    dark, light, joint = np.array([[0.62, 0.30, 0.20], [0.86, 0.79, 0.67], [0.52, 0.48, 0.44]])
    colour = np.where(chequer[..., None] == 1, dark, light) * (0.86 + 0.14 * own + 0.10 * (clouds(size, 11) - 0.5))[..., None]
    return opaque(np.clip(joint + (colour - joint) * np.clip(tile_height(size, count) * 2.0, 0.0, 1.0)[..., None], 0.0, 1.0))


def normals(height, strength):
    """The tangent-space normal map of float[N, N] heights that repeat; strength in texels."""
    along_u = (np.roll(height, -1, axis=1) - np.roll(height, 1, axis=1)) * 0.5 * strength
    along_v = (np.roll(height, -1, axis=0) - np.roll(height, 1, axis=0)) * 0.5 * strength
    normal = np.stack([-along_u, -along_v, np.ones_like(height)], axis=2)
    normal /= np.linalg.norm(normal, axis=2, keepdims=True)
    return opaque(normal * 0.5 + 0.5)


def plaster(size=128):
    """Blotches 0..1 in grey, to mix two colours by."""
    return opaque(np.repeat(np.clip(1.6 * clouds(size, 23) - 0.3, 0.0, 1.0)[..., None], 3, axis=2))


def lattice(size=256, cells=5):
    """A wooden screen of round holes within a diagonal grid, as colour with alpha."""
    place = ((np.arange(size) + 0.5) / size * cells) % 1.0 - 0.5
    x, y = np.meshgrid(place, place)
    from_middle = np.hypot(x, y)
    diagonal = np.minimum(np.abs(x - y), np.abs(x + y)) / np.sqrt(2.0)
    ring = np.abs(from_middle - 0.36)
    solid = np.minimum(np.minimum(diagonal - 0.045, ring - 0.06), 0.5 - np.maximum(np.abs(x), np.abs(y)) - 0.035)
    # One texel of ramp antialiases the border of the holes.
    alpha = np.clip(0.5 - solid * size / cells, 0.0, 1.0)
    grain = 0.75 + 0.25 * noise(size, 32, 31)
    return np.concatenate([np.array([0.36, 0.22, 0.13]) * grain[..., None], alpha[..., None]], axis=2).astype(np.float32)


def leaf(size=128):
    """A pointed leaf along u with veins, as colour with alpha."""
    u, v = np.meshgrid((np.arange(size) + 0.5) / size, (np.arange(size) + 0.5) / size)
    across = np.abs(v - 0.5)
    half_width = 0.46 * np.sin(np.pi * np.clip(u, 0.0, 1.0) ** 0.75) ** 0.8 + 0.012
    alpha = np.clip((half_width - across) * size * 0.7, 0.0, 1.0)
    veins = np.exp(-((across / 0.015) ** 2)) + 0.5 * np.exp(-((((u - across * 0.9) * 9.0 % 1.0 - 0.5) / 0.07) ** 2))
    green = np.array([0.20, 0.42, 0.16]) * (0.8 + 0.3 * noise(size, 8, 41))[..., None]
    return np.concatenate([np.clip(green + 0.16 * veins[..., None] * np.array([0.8, 1.0, 0.5]), 0.0, 1.0), alpha[..., None]],
                          axis=2).astype(np.float32)


def packed(name, pixels, data=False):
    """A packed 8-bit image of the pixels; data: values that are no colours (normals, masks)."""
    size = pixels.shape[0]
    image = bpy.data.images.new(name, size, size, alpha=True)
    image.colorspace_settings.name = "Non-Color" if data else "sRGB"
    image.pixels.foreach_set(np.ascontiguousarray(pixels, np.float32).ravel())
    image.update()
    image.pack()
    return image
