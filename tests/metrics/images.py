# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the pictures that the metrics compare.

Two ways of naming the channels of an EXR file occur here: Blender's multilayer files say
`LAYER.Combined.R`, and the shared references say `R` for Combined and `DiffDir.R` for the rest. Both
come out as one dictionary from the pass name to its pixels, so that a comparison never asks which
program wrote a file.
"""

from pathlib import Path

import numpy as np
import OpenImageIO as oiio

# The order in which the last part of channel names makes up a pixel.
CHANNEL_ORDER = "RGBAXYZWUV"
LDR_SUFFIXES = {".png", ".jpg", ".jpeg", ".bmp", ".tga"}


class ImageError(ValueError):
    """A picture that cannot be read or compared; the message is one sentence."""


def split_channel(name):
    """Splits a channel's name into (layer, pass, component); a bare `R` belongs to Combined of layer ""."""
    *front, component = name.split(".")
    if not front:
        return "", "Combined", component
    # Dots may occur in a layer's name, never in a pass name.
    return ".".join(front[:-1]), front[-1], component


def read_passes(path, layer=None):
    """Reads every pass of one layer.

    path: an EXR file (scene-linear, returned as it is) or an 8- or 16-bit picture (sRGB, returned linear).
    layer: the view layer's name; None takes the only layer that there is.
    Returns {pass name: float32[H, W, C]}, row 0 at the top; C is 1 for Depth, 3 or 4 for colours.
    Raises ImageError for a file that is missing, unreadable or has several layers to choose from.
    """
    path = Path(path)
    if not path.is_file():
        raise ImageError(f"There is no picture at {path}; render it first or correct the path.")
    source = oiio.ImageInput.open(str(path))
    if source is None:
        raise ImageError(f"{path} cannot be opened as a picture: {oiio.geterror().strip()}.")
    spec = source.spec()
    pixels = source.read_image(0, 0, 0, spec.nchannels, oiio.FLOAT)
    source.close()
    if pixels is None:
        raise ImageError(f"{path} is damaged: its pixels cannot be read; render it again.")
    pixels = np.asarray(pixels, np.float32).reshape(spec.height, spec.width, spec.nchannels)

    if path.suffix.lower() in LDR_SUFFIXES:
        colours = pixels[:, :, :3] if spec.nchannels >= 3 else np.repeat(pixels[:, :, :1], 3, axis=2)
        return {"Combined": srgb_to_linear(colours)}

    found = {}
    for index, name in enumerate(spec.channelnames):
        channel_layer, pass_name, component = split_channel(name)
        found.setdefault(channel_layer, {}).setdefault(pass_name, []).append((component, index))
    # Blender adds a composite of its own beside the view layers; the layers are what was rendered.
    if layer is None and len(found) > 1:
        found.pop("", None)
        found.pop("Composite", None)
    if layer is None and len(found) == 1:
        layer = next(iter(found))
    if layer not in found:
        names = ", ".join(sorted(found)) or "none"
        raise ImageError(f"{path} has the layers {names}; name one of them.")

    def place(entry):
        at = CHANNEL_ORDER.find(entry[0])
        return at if at >= 0 else len(CHANNEL_ORDER)

    return {name: np.ascontiguousarray(pixels[:, :, [index for _, index in sorted(entries, key=place)]])
            for name, entries in found[layer].items()}


def read_pass(path, name="Combined", layer=None):
    """Reads one pass as float32[H, W, C] without its alpha; raises ImageError where it is missing."""
    passes = read_passes(path, layer)
    if name not in passes:
        raise ImageError(f"{path} has no pass {name}; it has {', '.join(sorted(passes))}.")
    return passes[name][:, :, :3]


def read_mask(path):
    """Reads a picture as bool[H, W]: True where its first channel is above one half."""
    return next(iter(read_passes(path).values()))[:, :, 0] > 0.5


def write_exr(path, passes):
    """Writes {pass name: float[H, W, C]} as a 32-bit EXR with `PASS.R` names, Combined as plain `R`."""
    names, planes = [], []
    for name, pixels in passes.items():
        pixels = np.atleast_3d(np.asarray(pixels, np.float32))
        components = {1: "Z" if name == "Depth" else "Y", 3: "XYZ" if name == "Normal" else "RGB", 4: "RGBA"}
        for index, component in enumerate(components[pixels.shape[2]]):
            names.append(component if name == "Combined" else f"{name}.{component}")
            planes.append(pixels[:, :, index])
    stacked = np.ascontiguousarray(np.stack(planes, axis=-1))
    spec = oiio.ImageSpec(stacked.shape[1], stacked.shape[0], stacked.shape[2], oiio.FLOAT)
    spec.channelnames = names
    spec.attribute("compression", "zip")
    _write(path, spec, stacked)


def write_png(path, linear):
    """Writes float[H, W, 3] scene-linear as an 8-bit sRGB picture, clamped to 0..1, for looking at."""
    encoded = np.rint(linear_to_srgb(linear) * 255.0).astype(np.uint8)
    _write(path, oiio.ImageSpec(encoded.shape[1], encoded.shape[0], 3, oiio.UINT8), np.ascontiguousarray(encoded))


def _write(path, spec, pixels):
    out = oiio.ImageOutput.create(str(path))
    if out is None or not out.open(str(path), spec) or not out.write_image(pixels):
        raise ImageError(f"{path} cannot be written: {oiio.geterror().strip()}.")
    out.close()


def linear_to_srgb(linear):
    """The sRGB curve (IEC 61966-2-1) of values clamped to 0..1."""
    linear = np.clip(linear, 0.0, 1.0)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.power(linear, 1 / 2.4) - 0.055)


def srgb_to_linear(encoded):
    """The inverse of the sRGB curve, for encoded values in 0..1."""
    return np.where(encoded <= 0.04045, encoded / 12.92, np.power((encoded + 0.055) / 1.055, 2.4))
