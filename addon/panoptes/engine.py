# SPDX-License-Identifier: GPL-3.0-or-later
"""The RenderEngine that Blender calls. Nothing that happens inside may reach Blender as an exception."""

import bpy
from bpy.app.handlers import persistent

from . import final, native, passes, preview, requests, session
from .viewport import Viewport


class PanoptesRenderEngine(bpy.types.RenderEngine):
    """Panoptes in Blender's list of engines. Holds no native state of its own."""

    bl_idname = 'PANOPTES'
    bl_label = 'Panoptes'
    bl_use_preview = True
    bl_use_postprocess = True
    bl_use_shading_nodes_custom = False
    bl_use_eevee_viewport = True
    bl_use_gpu_context = False

    # Blender calls __init__ with arguments that differ by version, in 5.x more than once.
    def __init__(self, *args, **kwargs):
        super().__init__(*args, **kwargs)

    def update_render_passes(self, scene=None, renderlayer=None):
        """Tell Blender which passes a view layer will have."""
        for entry in passes.enabled(renderlayer):
            self.register_pass(scene, renderlayer, entry.name, entry.channels, entry.channel_ids,
                               entry.kind)

    def update(self, data, depsgraph):
        """Called before `render`; everything is read there, where errors can be shown."""

    def render(self, depsgraph):
        """Render one view layer of one frame, or a preview."""
        if self.is_preview:
            self._render_preview(depsgraph)
            return
        try:
            final.render(self, depsgraph)
        except requests.BadRequest as error:
            self._fail(native.one_line(error))
        except Exception as error:  # whatever it was, Blender must go on
            self._fail(session.sentence(error))

    def _render_preview(self, depsgraph):
        try:
            preview.render(self, depsgraph)
        except Exception as error:  # an icon stays empty, that is all
            session.sentence(error)

    def _fail(self, text):
        session.fail_final(text)
        # A report of this kind keeps Blender from writing a picture; the other shows in its window.
        self.report({'ERROR'}, text)
        if not bpy.app.background:
            self.update_stats('Panoptes', text)
            self.error_set(text)

    def view_update(self, context, depsgraph):
        """Called after edits while a 3D View is rendered."""
        self._viewport().update(self, context, depsgraph)

    def view_draw(self, context, depsgraph):
        """Draw the 3D View."""
        self._viewport().draw(self, context, depsgraph)

    def _viewport(self):
        viewport = getattr(self, 'viewport', None)
        if viewport is None:
            viewport = self.viewport = Viewport()
        return viewport


@persistent
def _on_render_init(scene, _=None):
    session.start_final()


@persistent
def _on_render_end(scene, _=None):
    """Store the statistics in the scene, where scripts and the panel find them."""
    if scene.render.engine != PanoptesRenderEngine.bl_idname:
        return
    text, name = session.stats_text(), scene.name

    def store():
        target = bpy.data.scenes.get(name)
        if target is not None:
            target.panoptes.last_stats = text

    # With a user interface this runs in the render job's thread, where data must not be written.
    if bpy.app.background:
        store()
    else:
        bpy.app.timers.register(store)


_HANDLERS = (('render_init', _on_render_init), ('render_complete', _on_render_end),
             ('render_cancel', _on_render_end))


def register():
    """Register the engine and the handlers around its renders."""
    bpy.utils.register_class(PanoptesRenderEngine)
    for name, handler in _HANDLERS:
        getattr(bpy.app.handlers, name).append(handler)


def unregister():
    """Undo `register`."""
    for name, handler in _HANDLERS:
        handlers = getattr(bpy.app.handlers, name)
        if handler in handlers:
            handlers.remove(handler)
    bpy.utils.unregister_class(PanoptesRenderEngine)
