# SPDX-License-Identifier: GPL-3.0-or-later
"""What indirect light is multiplied by on an object or in a region: `object.panoptes`.

Ten thousand objects are asked, and hardly one has been given a value.
"""

import math

# Far above any use, and far below what the GPU's half precision holds, also for an instance of an instance.
MOST = 100.0
NEUTRAL = (1.0, 1.0)


def of_object(thing, warn):
    """Return the (luminance, chrominance) of an evaluated object, each from 0 to `MOST`; `warn` takes sentences."""
    # Reading a group that has never been set would make one.
    if not thing.is_property_set('panoptes'):
        return NEUTRAL
    ours = thing.panoptes
    luminance, chrominance = ours.indirect_luminance, ours.indirect_chrominance
    if math.isnan(luminance) or math.isnan(chrominance):
        warn(f"The strength of indirect light of object '{thing.name}' is not a number; 1 is used instead. Set it "
             'again in its Indirect Light panel.')
        return NEUTRAL
    return min(max(luminance, 0.0), MOST), min(max(chrominance, 0.0), MOST)


def of_instance(thing, maker, warn):
    """Return the (luminance, chrominance) of an instance's evaluated object.

    `maker` is the object that makes the instance, or the object itself: each counts.
    """
    own = of_object(thing, warn)
    if maker == thing:
        return own
    makers = of_object(maker, warn)
    return own[0] * makers[0], own[1] * makers[1]
