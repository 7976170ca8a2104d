# SPDX-License-Identifier: GPL-3.0-or-later
"""Every difference between Blender 3.4 and 5.x that the add-on has to know."""

import bpy
import numpy as np

VERSION = bpy.app.version

# The Principled BSDF of 4.0 has other sockets and another diffuse term (Lambert, not Burley).
PRINCIPLED_GENERATION = 4 if VERSION >= (4, 0, 0) else 3

# Sockets of the Principled BSDF by the fields that they fill.
PRINCIPLED_SOCKETS = {
    'metallic': 'Metallic',
    'roughness': 'Roughness',
    'specular': 'Specular',
    'specular_tint': 'Specular Tint',
    'transmission': 'Transmission',
    'transmission_roughness': 'Transmission Roughness',
    'ior': 'IOR',
    'emission': 'Emission',
    'coat': 'Clearcoat',
    'coat_roughness': 'Clearcoat Roughness',
    'coat_normal': 'Clearcoat Normal',
    'sheen': 'Sheen',
    'sheen_tint': 'Sheen Tint',
    'subsurface': 'Subsurface',
    'subsurface_color': 'Subsurface Color',
    'anisotropic': 'Anisotropic',
    'base_color': 'Base Color',
}
if PRINCIPLED_GENERATION == 4:
    PRINCIPLED_SOCKETS.update({
        'specular': 'Specular IOR Level',
        'transmission': 'Transmission Weight',
        'emission': 'Emission Color',
        'coat': 'Coat Weight',
        'coat_roughness': 'Coat Roughness',
        'coat_ior': 'Coat IOR',
        'coat_tint': 'Coat Tint',
        'coat_normal': 'Coat Normal',
        'sheen': 'Sheen Weight',
        'sheen_roughness': 'Sheen Roughness',
        'subsurface': 'Subsurface Weight',
        'diffuse_roughness': 'Diffuse Roughness',
        'thin_film': 'Thin Film Thickness',
    })


# Nodes


def find_socket(sockets, name):
    """Return the socket with this identifier, else with this name, else None.

    Identifiers outlive the renamings (Fac became Factor in 5.x, its identifier stayed).
    """
    by_name = None
    for socket in sockets:
        if socket.identifier == name:
            return socket
        if by_name is None and socket.name == name and socket.enabled:
            by_name = socket
    return by_name


def uses_nodes(owner):
    """Tell whether a material, world or light is described by its node tree."""
    if owner.node_tree is None:
        return False
    # From 5.0 on (lamps: 5.2) the switch is always on, and reading it is deprecated.
    since = (5, 2, 0) if isinstance(owner, bpy.types.Light) else (5, 0, 0)
    if VERSION >= since:
        return len(owner.node_tree.nodes) > 0
    # A tree without nodes is black, as in Cycles.
    return owner.use_nodes


def displacement_method(material):
    """Return how a material is displaced: 'BUMP', 'DISPLACEMENT' or 'BOTH'."""
    # A property of Blender's own since 4.1, of Cycles' before.
    owner = material if hasattr(material, 'displacement_method') else getattr(material, 'cycles', None)
    return getattr(owner, 'displacement_method', 'BUMP')


# Data-blocks


def stable_key(data):
    """Return a hashable name of a data-block that lasts while it lives in this session."""
    data = data.original
    uid = getattr(data, 'session_uid', 0)
    if uid:
        return (data.bl_rna.identifier, uid)
    library = data.library.filepath if data.library else ''
    return (data.bl_rna.identifier, library, data.name)


def light_radiance_scale(light):
    """Return (r, g, b) by which a light's colour is multiplied, for settings newer than 3.4."""
    factor = 2.0 ** getattr(light, 'exposure', 0.0)
    if getattr(light, 'use_temperature', False):
        return tuple(c * factor for c in light.temperature_color)
    return (factor, factor, factor)


def light_casts_shadow(light):
    """Tell whether a light casts shadows, by Blender's switch and by that of Cycles before 4.x."""
    return light.use_shadow and getattr(getattr(light, 'cycles', None), 'cast_shadow', True)


def image_is_data(image):
    """Tell whether an image holds numbers (Non-Color), not colours."""
    return image.colorspace_settings.is_data


def image_is_srgb(image):
    """Tell whether an image's stored values are encoded with (nearly) the sRGB curve."""
    name = image.colorspace_settings.name
    linear = ('Linear', 'Non-Color', 'Raw', 'XYZ', 'ACES2065', 'ACEScg', 'Utility - Raw', 'scene_linear')
    return not image_is_data(image) and not name.startswith(linear)


def image_colors_are_exact(image):
    """Tell whether an image's colour space is one that is read as it is meant: sRGB or Rec.709 linear."""
    # Blender gives no name at all to what it could not read.
    names = ('sRGB', 'Linear', 'Linear Rec.709', 'Linear BT.709 I-D65', 'scene_linear', 'Raw', 'Utility - Raw', '')
    return image_is_data(image) or image.colorspace_settings.name in names


def image_has_straight_color(image):
    """Tell whether an image's colour is divided by alpha where a tree uses both."""
    return not image_is_data(image) and image.alpha_mode not in ('CHANNEL_PACKED', 'NONE')


def cycles_first_sample(settings):
    """Return the first sample of a scene's settings for Cycles."""
    # From 4.5 on the offset counts only where a subset is rendered.
    return settings.sample_offset if getattr(settings, 'use_sample_subset', True) else 0


# Meshes


def loop_normals(mesh):
    """Return the shading normals of a mesh's loops, float32[L, 3]."""
    normals = np.empty((len(mesh.loops), 3), np.float32)
    if VERSION >= (4, 1, 0):
        mesh.corner_normals.foreach_get('vector', normals.reshape(-1))
    else:
        mesh.calc_normals_split()
        mesh.loops.foreach_get('normal', normals.reshape(-1))
    return normals


def loop_vertices(mesh):
    """Return the vertex index of each loop, int32[L]."""
    vertices = np.empty(len(mesh.loops), np.int32)
    attribute = mesh.attributes.get('.corner_vert') if VERSION >= (3, 6, 0) else None
    if attribute is not None:
        attribute.data.foreach_get('value', vertices)
    else:
        mesh.loops.foreach_get('vertex_index', vertices)
    return vertices


def uv_coordinates(layer, count):
    """Return a UV map's coordinates, float32[count, 2]."""
    uv = np.empty((count, 2), np.float32)
    if hasattr(layer, 'uv'):
        layer.uv.foreach_get('vector', uv.reshape(-1))
    else:
        layer.data.foreach_get('uv', uv.reshape(-1))
    return uv


def default_color_name(mesh):
    """Return the name of the colour attribute that renders use, or ''."""
    colors = mesh.color_attributes
    name = getattr(mesh.attributes, 'default_color_name', None)
    if name is None:
        index = colors.render_color_index
        name = colors[index].name if 0 <= index < len(colors) else ''
    return name or ''


# Rendering


def write_pass(render_pass, pixels):
    """Fill a pass of a render result from float32[H, W, C], row 0 at the bottom."""
    flat = np.ascontiguousarray(pixels, np.float32)
    if VERSION >= (4, 0, 0):
        render_pass.rect.foreach_set(flat.reshape(-1))
    else:
        render_pass.rect.foreach_set(flat.reshape(-1, render_pass.channels))


def draw_pixels(pixels, left, bottom, width, height):
    """Draw scene-linear float32[H, W, 4] over a rectangle of the viewport's region, in pixels."""
    import gpu
    from gpu_extras.presets import draw_texture_2d

    pixels = np.ascontiguousarray(pixels, np.float32)
    rows, columns = pixels.shape[:2]
    data = gpu.types.Buffer('FLOAT', pixels.shape, pixels)
    texture = gpu.types.GPUTexture((columns, rows), format='RGBA32F', data=data)
    gpu.state.blend_set('ALPHA_PREMULT')
    draw_texture_2d(texture, (left, bottom), width, height)
    gpu.state.blend_set('NONE')


def view_text_color(preferences):
    """Return the colour (RGB) of highlighted text in 3D Views."""
    # Themes are rearranged from time to time; white is what most have.
    space = getattr(preferences.themes[0].view_3d, 'space', None)
    return tuple(getattr(space, 'text_hi', (1.0, 1.0, 1.0)))


def draw_text(lines, left, bottom, size, spacing, color):
    """Draw lines of text with a shadow, the last one at (left, bottom) of the region.

    `size` is in pixels, `spacing` from line to line in sizes, `color` RGB.
    """
    import blf

    font = 0
    # With two arguments the size is in pixels of 72 to an inch; the third has gone in 4.0.
    blf.size(font, size)
    blf.color(font, *color[:3], 1.0)
    blf.enable(font, blf.SHADOW)
    blf.shadow(font, 3, 0.0, 0.0, 0.0, 0.8)
    blf.shadow_offset(font, 1, -1)
    for index, line in enumerate(reversed(lines)):
        blf.position(font, left, bottom + index * spacing * size, 0.0)
        blf.draw(font, line)
    blf.disable(font, blf.SHADOW)


def set_file_format(settings, file_format):
    """Choose 'PNG' or 'OPEN_EXR_MULTILAYER' in an ImageFormatSettings."""
    if hasattr(settings, 'media_type'):
        layered = file_format == 'OPEN_EXR_MULTILAYER'
        settings.media_type = 'MULTI_LAYER_IMAGE' if layered else 'IMAGE'
    settings.file_format = file_format
    if hasattr(settings, 'use_exr_interleave'):
        # One part with all channels, as before 5.0: many readers look at the first part only.
        settings.use_exr_interleave = True


# User interface


def light_color_properties(light):
    """Return the names of the properties that make a light's colour in this version."""
    names = ['color']
    if hasattr(light, 'use_temperature'):
        names.append('use_temperature')
        if light.use_temperature:
            names.append('temperature')
    return names + (['exposure'] if hasattr(light, 'exposure') else [])


def light_shadow_switches(light):
    """Return (owner, property, label) of each switch that `light_casts_shadow` reads."""
    found = [(light, 'use_shadow', 'Cast Shadow')]
    cycles = getattr(light, 'cycles', None)
    if hasattr(cycles, 'cast_shadow'):
        found.append((cycles, 'cast_shadow', "Cycles' Switch"))
    return found


_offered = []


def offer_shader_nodes(engine):
    """Let the Add menu of the node editor offer shader nodes to this engine.

    Before 4.0 the menu asks for Cycles or EEVEE by name, through functions of a module of Blender's;
    later it asks whether EEVEE is not chosen.
    """
    if VERSION >= (4, 0, 0):
        return
    import nodeitems_builtins

    asked = nodeitems_builtins.cycles_shader_nodes_poll
    nodeitems_builtins.cycles_shader_nodes_poll = (
        lambda context: context.engine == engine or asked(context))
    _offered.append(asked)


def withdraw_shader_nodes():
    """Undo `offer_shader_nodes`."""
    while _offered:
        import nodeitems_builtins

        nodeitems_builtins.cycles_shader_nodes_poll = _offered.pop()
