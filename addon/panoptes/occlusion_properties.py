# SPDX-License-Identifier: GPL-3.0-or-later
"""`scene.panoptes.ambient_occlusion`, and the debug pictures of it."""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty

# Items of `scene.panoptes.debug_picture`.
PICTURES = (
    ('occlusion_multiview', 'Occlusion', 'What ambient occlusion finds by all its views: white is open, black '
                                         'is closed'),
    ('occlusion_single_view', "Occlusion, Camera Alone", 'The same by the camera alone, and never filtered. Where '
                                                         'the two differ, other views see what hides from the '
                                                         'camera'),
    ('occlusion_contribution', 'Occlusion by View', 'What the picture would lack without a view: red, green and '
                                                    'blue for the first three besides the camera, black where '
                                                    'the camera is enough'),
    ('occlusion_weights', 'Occlusion Weights', 'How much each view is trusted: red the camera, green and blue '
                                               'the first two others'),
    ('occlusion_samples', 'Occlusion Samples', 'Samples of all views, beside the most that there may be: blue '
                                               'few, red all of them'),
    ('occlusion_bent_normals', 'Bent Normals', 'The direction from which a surface is open to light: red, green '
                                               'and blue are X, Y and Z, with grey for 0'),
)


class PanoptesOcclusionSettings(bpy.types.PropertyGroup):
    """Options of ambient occlusion; all but the distance count for Real-time only."""

    estimator: EnumProperty(
        name='Estimator',
        description='How occlusion follows from what the views see around a point',
        items=(
            ('ALCHEMY', 'Alchemy', 'The best picture for the time, and what most scenes need'),
            ('SSAO', 'SSAO', 'Counts the hidden places around a point. Takes as long as Alchemy, and is rougher with '
                             'importance sampling'),
            ('HBAO', 'HBAO', 'Looks for the horizon in six directions, four samples each. Slowest; the number of '
                             'samples is fixed'),
        ),
        default='ALCHEMY')
    distance: FloatProperty(
        name='Distance',
        description='How far away things still darken a surface, in the picture of Real-time and in the Ambient '
                    'Occlusion pass of all methods. Contact shadows need a short one. 0 takes the distance of '
                    "the world's settings, as Cycles does",
        default=0.0, min=0.0, max=1e6, soft_max=100.0, precision=3, subtype='DISTANCE', unit='LENGTH')
    strength: FloatProperty(
        name='Strength',
        description="How much of the world's light occlusion takes away. 1 is all that it finds, 0 none and "
                    'costs nothing. The Ambient Occlusion pass is always at 1',
        default=1.0, min=0.0, max=1.0, subtype='FACTOR')
    samples: IntProperty(
        name='Samples',
        description='Samples of a view and pixel for each sample of the picture. More are smoother, and take as '
                    'much longer',
        default=15, min=1, max=256, soft_max=64)
    importance_sampling: BoolProperty(
        name='Importance Sampling',
        description='Begin with a few samples, and take the rest only where they are worth it: by views that see '
                    'the place well, and where something is hidden. Saves much time for slightly more noise',
        default=True)
    initial_samples: IntProperty(
        name='Initial Samples',
        description='Samples of every view by which the rest are dealt out. With too few of them, small things '
                    'are missed',
        default=5, min=1, max=256, soft_max=16)
    secondary_views: IntProperty(
        name='Lamp Views',
        description='Lamps whose shadow maps show what hides from the camera: those that add most, at most so '
                    'many. Each takes about as long as the camera. One or two are enough in most scenes',
        default=2, min=0, max=8)
    phantoms: EnumProperty(
        name='Phantom Views',
        description='Two small views from behind the camera that cross before it, and see around corners',
        items=(
            ('AUTO', 'Automatic', 'Used where camera and lamps see too little'),
            ('OFF', 'Off', 'Never used'),
            ('ON', 'On', 'Always used, which draws the scene twice more: for rooms that lamps do not reach into'),
        ),
        default='AUTO')
    phantom_resolution: IntProperty(
        name='Phantom Resolution',
        description='Pixels along the longer side of a phantom view. More than 512 take longer and show no more',
        default=256, min=16, max=4096, soft_min=64, soft_max=1024, subtype='PIXEL')
    phantom_cameras: PointerProperty(
        type=bpy.types.Collection,
        name='Phantom Cameras',
        description='Collection with cameras of your own, in place of the two behind the camera: the first four '
                    'by name. Place them where they see what the camera does not. While their collection '
                    'is hidden, they do not follow animation')
    filter: EnumProperty(
        name='Filter',
        description='Smooths noise away without blurring edges. Costs little; fine contact shadows become softer',
        items=(
            ('AUTO', 'Automatic', 'Used in pictures with few samples'),
            ('OFF', 'Off', 'Never used'),
            ('ON', 'On', 'Always used'),
        ),
        default='AUTO')
    deep_shadows: FloatProperty(
        name='Deep Shadows',
        description="Darkens the world's light also where lamps are blocked, which deepens their shadows and "
                    'softens the edges. A look, not what light does. 0 costs nothing',
        default=0.0, min=0.0, max=1.0, subtype='FACTOR')
