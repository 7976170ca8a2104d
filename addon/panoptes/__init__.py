# SPDX-License-Identifier: GPL-3.0-or-later
"""Panoptes: a global-illumination render engine on OpenGL.

This package is what Blender sees: engine, properties, panels, and the synchronisation of scenes with
the native module `panoptes_native`, which does all rendering.
"""

bl_info = {
    'name': 'Panoptes',
    'author': 'The Panoptes contributors',
    'version': (0, 1, 0),
    'blender': (3, 4, 0),
    'location': 'Render properties > Render Engine',
    'description': 'Global illumination of dynamic scenes by rasterisation from many views',
    'category': 'Render',
}


def register():
    """Make the engine, its properties and its panels known to Blender."""
    from . import engine, overlay, properties, user_interface, view_shading

    properties.register()
    engine.register()
    user_interface.register()
    view_shading.register()
    overlay.register()


def unregister():
    """Take back what `register` did and free the native engine."""
    from . import engine, native, overlay, properties, user_interface, view_shading

    overlay.unregister()
    view_shading.unregister()
    user_interface.unregister()
    engine.unregister()
    properties.unregister()
    native.close()
