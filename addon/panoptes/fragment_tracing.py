# SPDX-License-Identifier: GPL-3.0-or-later
"""Fragment tracing: its options, and the `fragments` of a request's settings."""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

_NAMES = ('views', 'side', 'camera_width', 'storage', 'buckets', 'bounds', 'layers', 'decoupled', 'skipping', 'binary_search',
          'walk', 'steps', 'thickness', 'by_plane')


class PanoptesFragmentSettings(bpy.types.PropertyGroup):
    """Options of fragment tracing: `scene.panoptes.fragment`."""

    views: EnumProperty(
        name='Views',
        description='From where the scene is drawn into layers of pixels, which are all that light meets',
        items=(
            ('CUBE_AND_CAMERA', 'Camera and Cube', "The camera's own view, and six around its eye"),
            ('CUBE', 'Cube', 'Six views around the eye'),
            ('CAMERA', 'Camera', 'What the camera does not see, no light meets'),
        ),
        default='CUBE_AND_CAMERA')
    side: IntProperty(
        name='Resolution', description='Pixels a side of each of the six views', default=256, min=1, max=4096,
        soft_min=64, soft_max=1024)
    camera_width: IntProperty(
        name='Camera Width',
        description="Pixels across the camera's view; 0 takes as many as the picture has, and no fewer than the six views "
                    'have there',
        default=0, min=0, max=16384)
    storage: EnumProperty(
        name='Storage',
        description='How the layers of a pixel lie in memory. The picture is the same; memory and time differ',
        items=(
            ('SB', 'Array', 'One behind the other'),
            ('LL', 'List', 'Each with a link to the next'),
            ('DLL', 'Double List', 'Linked both ways'),
            ('LLB', 'Bucket Lists', 'A list for each interval of depth'),
            ('DLLB', 'Bucket Double Lists', 'A list linked both ways for each interval of depth'),
        ),
        default='DLLB')
    buckets: IntProperty(
        name='Buckets', description='Intervals of depth of a pixel, where the storage has them', default=8, min=1, max=64)
    bounds: EnumProperty(
        name='Depth Bounds',
        description='Where the depths that a pixel divides into intervals come from',
        items=(
            ('EXACT', 'Exact', 'From all that the pixel shows'),
            ('BOXES', 'Boxes', 'From boxes about parts of the scene: no sooner, unless triangles are many and boxes small'),
        ),
        default='EXACT')
    layers: IntProperty(
        name='Layers',
        description='Layers that a pixel keeps, from the nearest on; 0 keeps all. Not with buckets', default=0, min=0,
        max=256)
    decoupled: BoolProperty(
        name='Decoupled Data', description='What only hits read lies apart from what every test reads', default=True)
    skipping: BoolProperty(
        name='Skip Empty Space', description='Pass over pixels and buckets whose depths a ray does not reach',
        default=True)
    binary_search: BoolProperty(
        name='Binary Search', description='Search arrays by halving them, in place of layer by layer', default=True)
    walk: EnumProperty(
        name='Walk',
        description='Which pixels of its way a ray looks into',
        items=(
            ('EVERY_PIXEL', 'Every Pixel', 'All of them, one after the other'),
            ('STEPS', 'Fixed Steps', 'A fixed number across each view: fast, and passes thin things by'),
            ('HIERARCHY', 'Hierarchy', 'All of them, but groups that are empty at once'),
        ),
        default='HIERARCHY')
    steps: IntProperty(name='Steps', description='Pixels across a view', default=32, min=1, max=4096)
    thickness: FloatProperty(
        name='Thickness',
        description='How far a surface goes on behind its pixel, as a share of the distance from the eye. With Exact '
                    'Surfaces, how far about the pixel it is looked for at least',
        default=0.02, min=0.0, max=1.0, precision=3)
    by_plane: BoolProperty(
        name='Exact Surfaces',
        description='Light meets the surface that a pixel shows, in place of anything at its depth: less is lost, and '
                    'surfaces do not shade themselves',
        default=True)


def settings(scene):
    """Return what the settings of a request by fragment tracing say of it."""
    ours = scene.panoptes.fragment
    found = {name: getattr(ours, name) for name in _NAMES}
    found.update({name: found[name].lower() for name in ('views', 'walk', 'bounds')})
    return {'fragments': found}


def draw(column, ours):
    """Draw the options into a panel's column."""
    column.prop(ours, 'views')
    if ours.views != 'CAMERA':
        column.prop(ours, 'side')
    if ours.views != 'CUBE':
        column.prop(ours, 'camera_width')
    column.prop(ours, 'by_plane')
    column.prop(ours, 'thickness')
    column.prop(ours, 'walk')
    if ours.walk == 'STEPS':
        column.prop(ours, 'steps')
    column.prop(ours, 'storage')
    if ours.storage in {'LLB', 'DLLB'}:
        column.prop(ours, 'buckets')
        column.prop(ours, 'bounds')
    # With buckets too, where it has to be 0: what a render complains of must be in sight.
    if ours.storage not in {'LLB', 'DLLB'} or ours.layers:
        column.prop(ours, 'layers')
    if ours.storage == 'SB':
        column.prop(ours, 'binary_search')
    column.prop(ours, 'decoupled')
    column.prop(ours, 'skipping')
