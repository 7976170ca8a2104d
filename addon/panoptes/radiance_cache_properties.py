# SPDX-License-Identifier: GPL-3.0-or-later
"""`scene.panoptes.radiance_cache`, the debug pictures of it, and `object.panoptes`."""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty

from . import indirect_scale

# Items of `scene.panoptes.debug_picture`.
PICTURES = (
    ('cache_light', 'Indirect Light', 'The indirect light that cells hold, on white surfaces'),
    ('cache_lobes', 'Indirect Light by Direction', 'A ball in each cell that is seen, with the light that arrives '
                                                   'there from all around'),
    ('cache_geometry', 'Voxels', 'The coarse geometry that stops indirect light, by its colour. Holes in it leak '
                                 'light'),
    ('cache_occupancy', 'Cells', 'Which cells hold light: green those that need it, red those that only their '
                                 'neighbours do'),
    ('cache_clipped', 'Clipped Light', 'Light that was cut off because cells know it by few directions, relative '
                                       'to what there is. Black is none'),
)


def _strength(name, what, update=None):
    return FloatProperty(
        name=name, description=f'{what}. 1 is as light does, 0 takes it away', default=1.0, min=0.0,
        max=indirect_scale.MOST, soft_max=2.0, precision=3, subtype='FACTOR',
        update=update)


def _tag(settings, _context):
    # Blender evaluates an object again by itself where the artist drags a value, not where a script sets it.
    settings.id_data.update_tag(refresh={'OBJECT'})


class PanoptesRadianceCacheSettings(bpy.types.PropertyGroup):
    """Options of indirect light in Real-time."""

    enabled: BoolProperty(
        name='Indirect Light',
        description='Gather light that surfaces reflect on each other, and the light of the world where the scene '
                    'is open to it, in cells throughout the scene. Without it nothing is lit by reflected light, '
                    'and the world shines into closed rooms',
        default=True)
    bounces: IntProperty(
        name='Bounces',
        description='How often light is reflected before it reaches what is seen. Real-time has no more than this, '
                    'and no more than Bounces of all methods. Each takes a little time; after two or three the '
                    'picture hardly changes. 0 leaves the light of the world alone',
        default=2, min=0, max=8)
    resolution: IntProperty(
        name='Resolution',
        description='Cells along the longest side of the scene, 4 to 64. Light cannot change within a cell, so '
                    'more show smaller things and leak less light through walls. Twice as many take about four '
                    'times as long, and eight times the memory. 0 chooses what suits the scene',
        default=0, min=0, max=64)
    voxels: IntProperty(
        name='Voxels',
        description='Voxels along the side of a cell. They are what stops light on its way: more of them make '
                    'thinner walls and smaller openings count',
        default=4, min=2, max=8)
    cascades: IntProperty(
        name='Cascades',
        description='Volumes of cells in one another, each twice as wide as the one in it, with the smallest about '
                    'the camera: fine cells nearby in a large scene. 1 is one volume for all of it. 0 leaves the '
                    'choice to Panoptes: as many as it takes for cells to be small in the picture',
        default=0, min=0, max=3)
    encoding: EnumProperty(
        name='Encoding',
        description='How finely cells tell from where light comes. Eyes tell directions by brightness, so colour '
                    'can do with less',
        items=(
            ('Y3CO1CG1', 'Brightness Fine, Colour Mean', 'Nine numbers a cell for brightness by direction, two for '
                                                         'a colour without any (Y3Co1Cg1). Fastest and smallest. '
                                                         'Light of coloured walls and of different lamps mixes'),
            ('Y3CO2CG2', 'Brightness Fine, Colour Coarse', 'Nine numbers for brightness, eight for colour (Y3Co2Cg2). '
                                                           'Keeps apart what coloured walls and different lamps '
                                                           'send, for half as much again'),
            ('Y3CO3CG3', 'Brightness and Colour Fine', '27 numbers (Y3Co3Cg3). Shows what is lost by the others; '
                                                       'takes more than twice as much'),
            ('RGB3', 'Red, Green and Blue Fine', '27 numbers (RGB3). The same quality and cost, for comparison'),
            ('Y2CO2CG2', 'Brightness and Colour Coarse', 'Twelve numbers (Y2Co2Cg2). As small as the first with less '
                                                         'detail, for comparison'),
            ('RGB2', 'Red, Green and Blue Coarse', 'Twelve numbers (RGB2). The same, for comparison'),
        ),
        default='Y3CO2CG2')
    luminance: _strength('Strength', 'Strength of light that comes from other surfaces; that of the world stays')
    chrominance: _strength('Colour', 'Strength of its colour: 0 is grey, more than 1 exaggerates it')
    region_collection: PointerProperty(
        type=bpy.types.Collection,
        name='Regions',
        description='Collection with boxes in which indirect light is stronger or weaker: empties that are displayed '
                    'as cubes, and the bounds of meshes. The first eight by name count. Their own strengths are in '
                    'the Object properties. While their collection is hidden, they do not follow animation')

    first_bounce: EnumProperty(
        name='First Bounce',
        description='Where the light of lamps is found that is reflected once',
        items=(
            ('SURFACES', 'Surfaces', 'On the surfaces that rays from a cell meet. Smoother for the time, and right '
                                     'behind corners'),
            ('RSM', 'Reflective Shadow Maps', "On random pixels of the lamps' shadow maps, as in the dissertation. "
                                              'As bright, but blotchy below 1000 samples, and slower for each '
                                              'lamp; for comparison'),
        ),
        default='SURFACES')
    directions: IntProperty(
        name='Directions',
        description='Rays by which each cell looks around. Fewer leave blotches, more take as much longer; beyond '
                    '128 nothing is gained',
        default=64, min=8, max=512)
    march_steps: IntProperty(
        name='Steps',
        description='Places along each ray where the voxels are looked at. 0 is every voxel on the way: with steps '
                    'light leaks where walls lie between two of them',
        default=0, min=0, max=256)
    voxel_fill: FloatProperty(
        name='Solid From',
        description='How much surface makes a voxel stop light, in faces of the voxel. Low values close small gaps '
                    'and darken, high ones open thin walls. 0 is any touch',
        default=0.75, min=0.0, max=1.0, precision=3, subtype='FACTOR')
    occupancy: EnumProperty(
        name='Cells',
        description='Which cells hold light; the others cost nothing',
        items=(
            ('AUTO', 'Automatic', 'What a picture needs: those that are seen for one bounce, in tiers for more; in 3D '
                                  'Views, which keep their light while they turn, and for mirrors all with surfaces'),
            ('GEOMETRY', 'With Surfaces', 'All at surfaces, seen or not: what further bounces need'),
            ('DEPTH', 'Seen', 'Those in which the camera sees something. Fewest; further bounces lack what comes '
                              'from elsewhere'),
            ('TIERS', 'In Tiers', 'Those, and in a quarter of the directions those with surfaces that are not seen, for '
                                  'the light that they send there'),
            ('ALL', 'All', 'Every one, in empty space, too. Slow; what the others are compared with'),
        ),
        default='AUTO')
    depth_stride: IntProperty(
        name='Stride',
        description='Pixels between those that tell which cells are seen. More is faster and may miss small things',
        default=4, min=1, max=64, subtype='PIXEL')
    dilate: BoolProperty(
        name='Dilate',
        description='Let the neighbours of these cells hold light, too, as in the dissertation. Without, cells take '
                    'half the time, and surfaces whose own cell lies behind them are dark',
        default=True)
    rsm_samples: IntProperty(
        name='Samples',
        description='Pixels of a shadow map for each lamp and cell. Noise falls with the square root of it',
        default=200, min=1, max=4096, soft_max=1000)
    rsm_resolution: IntProperty(
        name='Map Resolution',
        description='Pixels along a side of a reflective shadow map',
        default=128, min=16, max=1024, subtype='PIXEL')
    rsm_spread: FloatProperty(
        name='Spread',
        description='Part of a map from which a cell takes its samples, around where it is seen itself. 1 is all of '
                    'it, 0.8 what the dissertation shows; less is smoother if the whole map counts, too',
        default=0.25, min=0.01, max=1.0, subtype='FACTOR')
    rsm_mixed: BoolProperty(
        name='Whole Map Too',
        description='Take half of the samples from all of the map. Without it the light outside the spread is lost, '
                    'as in the dissertation',
        default=True)
    blend: FloatProperty(
        name='Keep',
        description='Share of the indirect light before that a 3D View shows while things move, where light has '
                    'hardly changed, so that it does not flicker. Where it has, the new light shows at once; a view '
                    'that rests and final renders keep none',
        default=0.8, min=0.0, max=0.98, subtype='FACTOR')
    rebuild_every: IntProperty(
        name='Rebuild Every',
        description='While things move in a 3D View, light meets them where they were up to so many frames ago, '
                    'which makes each frame cheaper. A view that rests and final renders know where they are',
        default=1, min=1, max=16)


class PanoptesObjectSettings(bpy.types.PropertyGroup):
    """Options of an object that Blender has no place for."""

    indirect_luminance: _strength('Strength', 'Strength of light from other surfaces that is seen on this object or in '
                                              'this region, in Real-time', _tag)
    indirect_chrominance: _strength('Colour', 'Strength of the colour of that light: 0 is grey, more than 1 '
                                              'exaggerates it', _tag)
