# SPDX-License-Identifier: GPL-3.0-or-later
"""The commands: render, merge, snapshot, viewport."""

import os

import bpy

from .. import compat, native, passes, requests, session
from . import options as scene_options
from .failure import Failure
from .files import check_output, replacing, write_json
from .merging import add_pieces, merge

_FORMATS = {'.png': 'PNG', '.exr': 'OPEN_EXR_MULTILAYER'}
# Old files hold the first bytes of a .blend; new ones are compressed with gzip or Zstandard.
_BLEND_MAGIC = (b'BLENDER', b'\x1f\x8b', b'\x28\xb5\x2f\xfd')


def _open(path):
    """Open a .blend; raises `Failure`."""
    if not os.path.exists(path):
        raise Failure(f"There is no file '{path}'; check the path.")
    if os.path.isdir(path):
        raise Failure(f"'{path}' is a folder; give a .blend file.")
    try:
        with open(path, 'rb') as file:
            start = file.read(8)
    except OSError as error:
        raise Failure(f"'{path}' cannot be read ({error.strerror}); check its permissions.") from None
    if not start.startswith(_BLEND_MAGIC):
        raise Failure(f"'{path}' is not a .blend file; give one that Blender has saved.")
    try:
        bpy.ops.wm.open_mainfile(filepath=os.path.abspath(path), load_ui=False, use_scripts=False)
    except RuntimeError as error:
        raise Failure(f"Blender {bpy.app.version_string} cannot open '{path}' "
                      f'({native.one_line(error)}); save it again with this version.') from None


def _prepare(options):
    """Open the file and bring its scene to what the options say; return the scene."""
    _open(options.file)
    scene = bpy.context.scene
    scene.render.engine = 'PANOPTES'
    scene_options.apply(options, scene)
    if scene.camera is None:
        raise Failure(f"'{options.file}' has no camera in scene '{scene.name}'; add a camera and "
                      'make it the active one.')
    return scene


def _set_output(scene, temporary, file_format):
    render, image = scene.render, scene.render.image_settings
    render.filepath = temporary
    render.use_overwrite = True
    render.use_placeholder = False
    render.use_file_extension = False
    compat.set_file_format(image, file_format)
    if file_format == 'PNG':
        image.color_mode = 'RGBA' if render.film_transparent else 'RGB'
        image.color_depth = '8'
        return
    image.color_depth = '32'
    image.exr_codec = 'ZIP'
    for layer in scene.view_layers:
        passes.enable_all(layer, requests.method(scene.panoptes))


def render(options, console):
    """Render one frame to a PNG (through the view transform) or a multilayer EXR (scene-linear)."""
    path = check_output(options.output, tuple(_FORMATS))
    stats_path = check_output(options.stats) if options.stats else None
    scene = _prepare(options)
    file_format = _FORMATS[os.path.splitext(path)[1].lower()]
    session.progress_listener = console.progress
    # An explicit range is a part of a picture that somebody wants to put together.
    session.keep_pieces = options.samples is not None and options.samples.is_range and file_format != 'PNG'
    try:
        with replacing(path) as temporary:
            _set_output(scene, temporary, file_format)
            _render_frame()
            add_pieces(temporary, console)
    finally:
        session.progress_listener = None
        session.keep_pieces = False
        console.clear()
    stats = session.last_stats
    for sentence in stats['warnings']:
        console.warning(sentence)
    if stats_path:
        write_json(stats_path, stats)


def _render_frame():
    """Do what F12 does and save; raises `Failure`."""
    try:
        bpy.ops.render.render(write_still=True)
    except RuntimeError as error:
        if not session.last_error:
            raise Failure(f'Blender could not render ({native.one_line(error)}); open the file in '
                          'Blender and render it there for details.') from None
    if session.last_error:
        raise Failure(session.last_error)
    if session.last_stats is None:
        raise Failure('Nothing was rendered; enable a view layer for rendering, and the Scene strip '
                      'or the compositor only where they lead to a picture.')


def snapshot(options, console):
    """Write the scene and the request of a render for the command-line driver."""
    path = check_output(options.output)
    _prepare(options)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    warnings = []
    request = requests.final(depsgraph, (), warnings.append)
    request['passes'] = [entry.name for entry in passes.filled_by(request['method'])]
    with session.exclusive(wait=True):
        console.progress(0.0, 'Synchronising the scene')
        mirror = session.mirror()
        report = session.final_sync.sync(mirror, depsgraph, incremental=False)
        with replacing(path) as temporary:
            mirror.engine.write_snapshot(temporary, request)
    console.clear()
    for sentence in dict.fromkeys(warnings + report.warnings):
        console.warning(sentence)


def viewport(options, console):
    """Open a file with Panoptes chosen and every 3D View rendered; Blender stays open."""
    if bpy.app.background:
        raise Failure('The viewport needs a window; start it on a machine with a display.')
    path = os.path.abspath(options.file)
    _open(path)
    _show_rendered()


def _show_rendered():
    for scene in bpy.data.scenes:
        scene.render.engine = 'PANOPTES'
    for screen in bpy.data.screens:
        for area in screen.areas:
            for space in area.spaces:
                if space.type == 'VIEW_3D':
                    space.shading.type = 'RENDERED'
                    if bpy.context.scene.camera is not None:
                        # What the file's author framed says more than the default view.
                        space.region_3d.view_perspective = 'CAMERA'
                elif space.type == 'PROPERTIES':
                    space.context = 'RENDER'


COMMANDS = {'render': render, 'merge': merge, 'snapshot': snapshot, 'viewport': viewport}
