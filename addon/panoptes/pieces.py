# SPDX-License-Identifier: GPL-3.0-or-later
"""Which final renders can be merged with others, and what must agree between them."""

import json

from . import native


def can_merge(request, warn):
    """Tell whether the samples of a request can be merged with others; warns where they should be."""
    settings = request['settings']
    if settings.get('noise_threshold'):
        warn('Samples that end at a noise threshold cannot be merged with others; set Noise Threshold to '
             '0 to keep the pieces for that.')
        return False
    return 'debug_picture' not in settings


def merge_key(scene, request):
    """Return as JSON what must agree between requests whose samples are merged."""
    key = {name: value for name, value in request.items()
           if name not in ('samples', 'live', 'pieces', 'settings', 'view', 'projection')}
    key.update(request['settings'])
    for technique in ('occlusion', 'cache', 'specular_rays', 'fragments'):
        for name, value in key.pop(technique, {}).items():
            key[f'{technique}_{name}'] = value
    key.pop('time_budget', None)
    key['passes'] = sorted(request['passes'])
    key['camera'] = [request['view'].tolist(), request['projection'].tolist()]
    key['scene'], key['frame'] = scene.name, scene.frame_current_final
    key['version'] = native.module().__version__
    return json.dumps({name.replace('_', ' '): value for name, value in key.items()}, sort_keys=True)
