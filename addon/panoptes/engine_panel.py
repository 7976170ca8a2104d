# SPDX-License-Identifier: GPL-3.0-or-later
"""What all panels of Panoptes have in common."""

ENGINE = 'PANOPTES'
# Objects with a surface that rays can meet.
GEOMETRY = {'MESH', 'CURVE', 'SURFACE', 'META', 'FONT', 'CURVES', 'POINTCLOUD', 'VOLUME'}


class EnginePanel:
    """Common part of all panels; they are in the Render tab unless they say otherwise."""

    bl_space_type = 'PROPERTIES'
    bl_region_type = 'WINDOW'
    bl_context = 'render'
    COMPAT_ENGINES = {ENGINE}

    @classmethod
    def poll(cls, context):
        """Show the panel for Panoptes only."""
        return context.engine in cls.COMPAT_ENGINES

    def _column(self):
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        return self.layout.column()
