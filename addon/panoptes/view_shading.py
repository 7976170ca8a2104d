# SPDX-License-Identifier: GPL-3.0-or-later
"""What each 3D View shows in Rendered shading: `space.shading.panoptes`, and its place in the popover."""

from typing import NamedTuple

import bpy
from bpy.props import BoolProperty, EnumProperty, PointerProperty

from .engine_panel import ENGINE


class ViewPass(NamedTuple):
    """What a 3D View can show: an entry of its menu, and the name of the pass.

    `by_paths` tells whether paths of light find it better than Real-time, which knows all else exactly.
    """

    identifier: str
    label: str
    description: str
    name: str
    by_paths: bool = False


VIEW_PASSES = (
    ViewPass('COMBINED', 'Combined', 'The finished picture', 'Combined', by_paths=True),
    ViewPass('EMISSION', 'Emission', 'What surfaces emit themselves', 'Emit'),
    ViewPass('ENVIRONMENT', 'Environment', 'The world behind the scene', 'Env'),
    ViewPass('AO', 'Ambient Occlusion', 'How open surfaces are to what is around them: white is open', 'AO',
             by_paths=True),
    ViewPass('NORMAL', 'Normal', 'Where surfaces face: red, green and blue are X, Y and Z of the world, with '
                                 'grey for 0. The view transform Standard leaves the colours as they are',
             'Normal'),
    ViewPass('DIFFUSE_DIRECT', 'Diffuse Direct', 'Light on white matt surfaces straight from lamps, glowing '
                                                 'surfaces and the world', 'DiffDir', by_paths=True),
    ViewPass('DIFFUSE_INDIRECT', 'Diffuse Indirect', 'Light on white matt surfaces by way of others', 'DiffInd',
             by_paths=True),
    ViewPass('DIFFUSE_COLOR', 'Diffuse Color', 'The colour of matt surfaces without light', 'DiffCol'),
)
COMBINED = VIEW_PASSES[0]
_BY_IDENTIFIER = {entry.identifier: entry for entry in VIEW_PASSES}


class PanoptesViewShading(bpy.types.PropertyGroup):
    """Options of one 3D View."""

    render_pass: EnumProperty(
        name='Render Pass', description='What this 3D View shows. Only what that needs is computed',
        items=[entry[:3] for entry in VIEW_PASSES], default='COMBINED')
    show_statistics: BoolProperty(
        name='Render Statistics',
        description='Write into the corner of this 3D View how far its picture has come, what takes the time '
                    'and what is skipped, while overlays are shown',
        default=False)


def shown(scene, space):
    """Return the `ViewPass` that a 3D View (None: any) shows; a debug picture takes the place of all."""
    if space is None or scene.panoptes.debug_picture != 'none':
        return COMBINED
    return _BY_IDENTIFIER.get(space.shading.panoptes.render_pass, COMBINED)


class PANOPTES_PT_view_pass(bpy.types.Panel):
    """What a 3D View shows; the debug pictures are the scene's, as final renders show them too."""

    bl_label = 'Render Pass'
    bl_space_type = 'VIEW_3D'
    bl_region_type = 'HEADER'
    bl_parent_id = 'VIEW3D_PT_shading'

    @classmethod
    def poll(cls, context):
        """Show the panel in 3D Views that Panoptes renders."""
        return context.engine == ENGINE and context.space_data.shading.type == 'RENDERED'

    def draw(self, context):
        """Draw the panel."""
        ours, settings = context.space_data.shading.panoptes, context.scene.panoptes
        column = self.layout.column()
        row = column.row()
        row.active = settings.debug_picture == 'none'
        row.prop(ours, 'render_pass', text='')
        column.label(text='Debug Picture (Scene)')
        column.prop(settings, 'debug_picture', text='')
        column.prop(ours, 'show_statistics')


def register():
    """Add `panoptes` to the shading of all 3D Views, and its panel."""
    bpy.utils.register_class(PanoptesViewShading)
    bpy.types.View3DShading.panoptes = PointerProperty(type=PanoptesViewShading)
    bpy.utils.register_class(PANOPTES_PT_view_pass)


def unregister():
    """Undo `register`."""
    bpy.utils.unregister_class(PANOPTES_PT_view_pass)
    del bpy.types.View3DShading.panoptes
    bpy.utils.unregister_class(PanoptesViewShading)
