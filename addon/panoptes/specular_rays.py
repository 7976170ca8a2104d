# SPDX-License-Identifier: GPL-3.0-or-later
"""Traced reflections and refractions in Real-time: their options, and the `specular_rays` of a request."""

import bpy
from bpy.props import EnumProperty, FloatProperty


class PanoptesSpecularRaysSettings(bpy.types.PropertyGroup):
    """Options of specular rays in Real-time: `scene.panoptes.specular_rays`."""

    mode: EnumProperty(
        name='Specular Rays',
        description='Rays that find what is seen in mirrors and through glass, one a pixel and sample. Elsewhere '
                    'reflections show indirect light without detail',
        items=(
            ('AUTO', 'Automatic', 'From mirrors and glass, where the scene has any'),
            ('OFF', 'Off', 'From nowhere: fastest, and mirrors show blurred light'),
            ('ON', 'On', 'From everything that shines, however rough. Slow, and rough surfaces need many samples'),
        ),
        default='AUTO')
    roughness: FloatProperty(
        name='Roughness',
        description='Surfaces that are rougher than this send no rays when they are chosen automatically',
        default=0.3, min=0.0, max=1.0, subtype='FACTOR')


def settings(scene):
    """Return the `specular_rays` of a request."""
    ours = scene.panoptes.specular_rays
    return {'mode': ours.mode.lower(), 'roughness': ours.roughness}
