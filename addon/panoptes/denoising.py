# SPDX-License-Identifier: GPL-3.0-or-later
"""Denoising of pictures by paths: its options, and the `denoise` of a request's settings."""

import bpy
from bpy.props import BoolProperty, EnumProperty

MERGED = ('Parts of a picture that are to be merged are not denoised; switch off Denoise Render, and denoise what '
          'they are merged to.')


class PanoptesDenoiseSettings(bpy.types.PropertyGroup):
    """Options of the denoiser: `scene.panoptes.denoise`."""

    viewport: BoolProperty(
        name='Viewport',
        description='Take the noise out of paths in 3D Views, while samples are added',
        default=True)
    final: BoolProperty(
        name='Render',
        description='Take the noise out of final renders by paths. The pass Noisy Image keeps what was there before',
        default=False)
    denoiser: EnumProperty(
        name='Denoiser',
        description='What takes the noise out',
        items=(
            ('AUTO', 'Automatic', 'OpenImageDenoise where the computer has it, else Edge-Avoiding'),
            ('EDGE_AVOIDING', 'Edge-Avoiding', 'Smooths as far as the noise goes and surfaces are alike: fast, and '
                                               'what it is unsure of stays noisy'),
            ('OIDN', 'OpenImageDenoise', 'Trained on pictures of many scenes. Has to be installed on the computer'),
        ),
        default='AUTO')


def settings(scene, viewport):
    """Return what the settings of a request by paths say of the denoiser; {} where it is off."""
    ours = scene.panoptes.denoise
    return {'denoise': ours.denoiser.lower()} if (ours.viewport if viewport else ours.final) else {}
