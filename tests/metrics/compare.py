#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares a picture with its reference and prints every metric.

    tests/metrics/compare.py A.exr REFERENCE.exr [--pass NAME] [--mask MASK.png] [--difference OUT.png]
    tests/metrics/compare.py A.exr REFERENCE.exr --at-most relative_rmse=0.02

Exit status: 0, or 1 where a bound given by --at-most is exceeded, or 2 where nothing can be compared.
"""

import argparse
import json
import sys

import numpy as np

import images
import metrics


def bound(text):
    """Reads METRIC=VALUE."""
    name, _, value = text.partition("=")
    return name, float(value)


def difference_picture(test, reference, gain):
    """Test, reference and their difference side by side, as linear float[H, 3 W, 3].

    In the difference grey is no error, red too bright, blue too dark; `gain` times the error in linear
    light, averaged over the channels.
    """
    error = np.clip(gain * (test - reference).mean(axis=2), -1.0, 1.0)
    red, blue = np.maximum(error, 0.0), np.maximum(-error, 0.0)
    signed = 0.2 + np.stack([0.8 * red - 0.2 * blue, -0.2 * (red + blue), 0.8 * blue - 0.2 * red], axis=-1)
    return np.concatenate([test, reference, signed], axis=1)


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("test", help="the picture to judge: EXR, or PNG taken as sRGB")
    parser.add_argument("reference")
    parser.add_argument("--pass", dest="pass_name", default="Combined", metavar="NAME",
                        help="Combined, DiffDir, DiffCol, Normal, Depth, ... (default Combined)")
    parser.add_argument("--layer", help="the view layer, where a file has several")
    parser.add_argument("--mask", help="a picture; only pixels above one half count")
    parser.add_argument("--difference", metavar="OUT.png", help="write both and their difference, side by side")
    parser.add_argument("--gain", type=float, default=4.0, help="how much --difference amplifies the error")
    parser.add_argument("--at-most", type=bound, action="append", default=[], metavar="METRIC=VALUE")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args(arguments)

    try:
        test, reference = (images.read_pass(path, options.pass_name, options.layer if path == options.test else None)
                           for path in (options.test, options.reference))
        mask = images.read_mask(options.mask) if options.mask else None
        values = metrics.all_metrics(test, reference, mask)
        if options.difference:
            images.write_png(options.difference, difference_picture(test, reference, options.gain))
        unknown = [name for name, _ in options.at_most if name not in values]
        if unknown:
            raise ValueError(f"There is no metric {unknown[0]}; choose from {', '.join(values)}.")
    except ValueError as error:
        print(error, file=sys.stderr)
        return 2

    if options.json:
        print(json.dumps({**values, "kept": float(mask.mean()) if mask is not None else 1.0}))
    else:
        for name, value in values.items():
            print(f"{name:16} {value:.6g}")
        if mask is not None:
            print(f"{'pixels kept':16} {mask.mean():.1%}")
    exceeded = [(name, values[name], most) for name, most in options.at_most if not values[name] <= most]
    for name, value, most in exceeded:
        print(f"{name} is {value:.6g}, above the {most:g} that is allowed.", file=sys.stderr)
    return 1 if exceeded else 0


if __name__ == "__main__":
    sys.exit(main())
