# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings that the sections of the bench compare, as settings['occlusion'] of a request has them."""

ESTIMATORS = ("alchemy", "ssao", "hbao")
# Where the dissertation deals out the rest of the 15 samples (Figure 4.7).
INITIAL_SAMPLES = {"alchemy": 5, "ssao": 7, "hbao": 5}

SINGLE, LAMPS, LAMPS_IS, PHANTOMS_IS = "single view", "lamps", "lamps + IS", "phantoms + IS"
_VIEWS = {
    SINGLE: {"secondary_views": 0, "phantoms": "off", "importance_sampling": False},
    LAMPS: {"secondary_views": 2, "phantoms": "off", "importance_sampling": False},
    LAMPS_IS: {"secondary_views": 2, "phantoms": "off", "importance_sampling": True},
    PHANTOMS_IS: {"secondary_views": 2, "phantoms": "on", "importance_sampling": True},
}


def variants(estimator):
    """{name: settings} of one estimator. HBAO has the same samples in any case, so that nothing is dealt out."""
    dealt = {"estimator": estimator, "initial_samples": INITIAL_SAMPLES[estimator]}
    return {name: {**dealt, **settings} for name, settings in _VIEWS.items() if estimator != "hbao" or name != LAMPS_IS}
