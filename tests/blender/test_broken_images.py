# SPDX-License-Identifier: GPL-3.0-or-later
"""Image files of every kind, sound and broken: each is shown or warned about, and none stops a render."""

import base64
import struct
import zlib

import bpy
import numpy as np
import pytest

from building import add_object, quad
from panoptes import compat, native, session

GREY, RGB, PALETTE, GREY_ALPHA, RGBA = 0, 2, 3, 4, 6
SIDE = 8
# 8x8 pixels of pure red, stored as cyan, magenta, yellow and black.
CMYK_JPEG = base64.b64decode(
    '/9j/7gAOQWRvYmUAZAAAAAAC/9sAQwANCQoLCggNCwoLDg4NDxMgFRMSEhMnHB4XIC4pMTAuKS0sMzpKPjM2RjcsLUBX'
    'QUZMTlJTUjI+WmFaUGBKUVJP/9sAQwEODg4TERMmFRUmTzUtNU9PT09PT09PT09PT09PT09PT09PT09PT09PT09PT09P'
    'T09PT09PT09PT09PT09PT09P/8AAFAgACAAIBAEiAAIRAQMRAQQiAP/EABYAAQEBAAAAAAAAAAAAAAAAAAAFB//EABQQ'
    'AQAAAAAAAAAAAAAAAAAAAAD/xAAVAQEBAAAAAAAAAAAAAAAAAAAFB//EABQRAQAAAAAAAAAAAAAAAAAAAAD/2gAOBAEA'
    'AhEDEQQAAD8AvgGU2acA/9k=')


def png(kind, texel, depth=8, size=(SIDE, SIDE), extra=()):
    """The bytes of a PNG whose pixels all hold `texel`; `extra` are chunks before the pixels."""
    def chunk(name, data):
        return struct.pack('>I', len(data)) + name + data + struct.pack('>I', zlib.crc32(name + data))

    header = struct.pack('>IIBBBBB', *size, depth, kind, 0, 0, 0)
    row = b'\0' + struct.pack(f'>{SIDE * len(texel)}{"B" if depth == 8 else "H"}', *texel * SIDE)
    pixels = row * SIDE
    return (b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', header)
            + b''.join(chunk(*parts) for parts in extra)
            + chunk(b'IDAT', zlib.compress(pixels)) + chunk(b'IEND', b''))


def linear(code):
    return code / 12.92 if code <= 0.04045 else ((code + 0.055) / 1.055) ** 2.4


@pytest.fixture
def shown(scene, native_module, tmp_path):
    """Returns a function that renders a plane with an image file of these bytes."""
    native.use_factory(None)
    scene.render.resolution_x, scene.render.resolution_y = 8, 8
    scene.camera.data.type, scene.camera.data.ortho_scale = 'ORTHO', 0.5
    scene.camera.location = (0.5, 0.5, 1.0)

    def show(data, name='image.png'):
        path = tmp_path / name
        path.write_bytes(data)
        material = bpy.data.materials.new('Shown')
        material.use_nodes = True
        tree = material.node_tree
        tree.nodes.clear()
        texture = tree.nodes.new('ShaderNodeTexImage')
        texture.image = bpy.data.images.load(str(path), check_existing=False)
        emission = tree.nodes.new('ShaderNodeEmission')
        output = tree.nodes.new('ShaderNodeOutputMaterial')
        tree.links.new(texture.outputs['Color'], emission.inputs['Color'])
        tree.links.new(emission.outputs[0], output.inputs['Surface'])
        mesh = quad()
        mesh.uv_layers.new(name='Map').data.foreach_set('uv', np.float32([0, 0, 1, 0, 1, 1, 0, 1]))
        mesh.materials.append(material)
        add_object(mesh)
        compat.set_file_format(scene.render.image_settings, 'OPEN_EXR')
        scene.render.image_settings.color_depth = '32'
        scene.render.filepath = str(tmp_path / 'picture.exr')
        bpy.ops.render.render(write_still=True)
        assert session.last_error == ''
        picture = bpy.data.images.load(scene.render.filepath)
        pixels = np.empty(8 * 8 * 4, np.float32)
        picture.pixels.foreach_get(pixels)
        assert np.isfinite(pixels).all()
        return pixels.reshape(8, 8, 4)[4, 4, :3], session.last_stats['warnings']

    return show


SOUND = {
    'grey': (png(GREY, (51,)), [linear(0.2)] * 3),
    'colour': (png(RGB, (51, 102, 255)), [linear(0.2), linear(0.4), 1]),
    'colour in 16 bits': (png(RGB, (13107, 26214, 65535), depth=16), [linear(0.2), linear(0.4), 1]),
    'grey in 16 bits': (png(GREY, (13107,), depth=16), [linear(0.2)] * 3),
    'opaque grey and alpha': (png(GREY_ALPHA, (51, 255)), [linear(0.2)] * 3),
    'opaque alpha': (png(RGBA, (51, 102, 255, 255)), [linear(0.2), linear(0.4), 1]),
    'palette': (png(PALETTE, (1,), extra=[(b'PLTE', bytes([0, 0, 0, 51, 102, 255]))]),
                [linear(0.2), linear(0.4), 1]),
    # Colour is multiplied by alpha in codes, as in Cycles.
    'palette with alpha': (png(PALETTE, (1,), extra=[(b'PLTE', bytes([0, 0, 0, 255, 255, 255])),
                                                     (b'tRNS', bytes([0, 128]))]),
                           [linear(128 / 255)] * 3),
    'grey and alpha': (png(GREY_ALPHA, (255, 128)), [linear(128 / 255)] * 3),
}


class TestFiles:
    """Files as artists have them."""

    @pytest.mark.parametrize('name', SOUND)
    def test_sound(self, shown, name):
        data, due = SOUND[name]
        color, warnings = shown(data)
        assert np.allclose(color, due, atol=2e-3), color
        assert warnings == []

    def test_cmyk_jpeg(self, shown):
        (red, green, blue), warnings = shown(CMYK_JPEG, 'image.jpg')
        assert red > 0.9 and green < 0.1 and blue < 0.1
        assert warnings == []

    @pytest.mark.parametrize('depth', ('16', '32'))
    def test_open_exr_with_values_that_are_no_numbers(self, scene, shown, tmp_path, depth):
        image = bpy.data.images.new('Broken', 4, 4, float_buffer=True)
        image.pixels.foreach_set(np.tile(np.float32([np.nan, 3.0, np.inf, 1.0]), 16))
        settings = scene.render.image_settings
        compat.set_file_format(settings, 'OPEN_EXR')
        settings.color_depth = depth
        image.save_render(str(tmp_path / 'made.exr'), scene=scene)
        color, warnings = shown((tmp_path / 'made.exr').read_bytes(), 'image.exr')
        # Blender itself writes infinity as the largest half.
        assert np.allclose(color[:2], (0.0, 3.0), atol=1e-3) and color[2] in (0.0, 65504.0)
        assert warnings == []


class TestDamage:
    """Files that hold less than they promise: a picture comes all the same."""

    def sound(self, tmp_path, kind, name):
        """A file of noise that does not fit into one block of any format."""
        image = bpy.data.images.new('Noise', 64, 64)
        image.pixels.foreach_set(np.random.default_rng(2).random(64 * 64 * 4, np.float32))
        image.filepath_raw, image.file_format = str(tmp_path / name), kind
        image.save()
        return (tmp_path / name).read_bytes()

    @pytest.mark.parametrize('kind, name', (('PNG', 'cut.png'), ('JPEG', 'cut.jpg'),
                                            ('TARGA', 'cut.tga'), ('OPEN_EXR', 'cut.exr')))
    def test_cut_off(self, shown, tmp_path, kind, name):
        data = self.sound(tmp_path, kind, name)
        # Blender 3.4 itself hangs on an OpenEXR of 40 bytes, whoever renders.
        for length in (len(data) // 2, 3) if kind == 'OPEN_EXR' else (len(data) // 2, 40, 3):
            color, warnings = shown(data[:length], name)
            # What could be read is shown, by whoever could; otherwise the colour of missing images.
            if tuple(color) == (1.0, 0.0, 1.0):
                assert any(name in sentence for sentence in warnings), (length, warnings)

    def test_empty(self, shown):
        color, (warning,) = shown(b'')
        assert tuple(color) == (1.0, 0.0, 1.0)
        assert 'image.png' in warning and 'Find Missing Files' in warning

    def test_another_format_than_its_name_says(self, shown):
        color, warnings = shown(png(GREY, (51,)), 'image.jpg')
        assert np.allclose(color, linear(0.2), atol=2e-3) and warnings == []

    @pytest.mark.parametrize('size', ((4 * SIDE, SIDE), (SIDE, 4 * SIDE), (40000, 40000)))
    def test_more_pixels_promised_than_held(self, shown, size):
        # 40000 x 40000 would be 6 GB that nobody has to touch.
        shown(png(RGBA, (255, 255, 255, 255), size=size))
