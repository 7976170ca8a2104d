# SPDX-License-Identifier: GPL-3.0-or-later
"""Images on their way to the native side."""

import os

import bpy
import numpy as np
import pytest

from building import Sync, add_object, quad


@pytest.fixture
def sync(scene, recorder):
    return Sync(recorder)


class TestImages:
    """The three ways of an image, and the missing one."""

    def textured(self, image):
        material = bpy.data.materials.new('Painted')
        material.use_nodes = True
        tree = material.node_tree
        node = tree.nodes.new('ShaderNodeTexImage')
        node.image = image
        shader = next(n for n in tree.nodes if n.type == 'BSDF_PRINCIPLED')
        tree.links.new(node.outputs[0], shader.inputs['Base Color'])
        mesh = quad()
        mesh.materials.append(material)
        add_object(mesh)

    def saved(self, tmp_path):
        image = bpy.data.images.new('Saved', 4, 4)
        image.filepath_raw, image.file_format = str(tmp_path / 'saved.png'), 'PNG'
        image.save()
        bpy.data.images.remove(image)
        return bpy.data.images.load(str(tmp_path / 'saved.png'))

    def test_generated(self, sync):
        image = bpy.data.images.new('Made', 4, 2)
        image.pixels.foreach_set(np.tile(np.float32([1, 0.5, 0, 1]), 8))
        self.textured(image)
        sync.run()
        ((_, name, pixels, srgb, alpha),) = sync.recorder.arguments('set_image_pixels')
        assert name == 'Made' and pixels.shape == (2, 4, 4) and pixels.dtype == np.uint8
        assert srgb and alpha == 'STRAIGHT'
        assert pixels[0, 0].tolist() == [255, 128, 0, 255]

    def test_generated_floats(self, sync):
        image = bpy.data.images.new('Made', 2, 2, float_buffer=True)
        image.pixels.foreach_set(np.tile(np.float32([7, 0.5, 0, 1]), 4))
        self.textured(image)
        sync.run()
        ((_, _, pixels, srgb, _),) = sync.recorder.arguments('set_image_pixels')
        assert pixels.dtype == np.float32 and pixels[0, 0].tolist() == [7, 0.5, 0, 1]
        assert not srgb

    def test_unusual_colour_space_is_named(self, sync):
        image = bpy.data.images.new('Made', 4, 2)
        for name in ('Linear ACEScg', 'ACEScg'):  # before and since Blender 4.0
            try:
                image.colorspace_settings.name = name
            except TypeError:
                continue
        self.textured(image)
        _, report = sync.run()
        (warning,) = report.warnings
        assert "'Made'" in warning and 'ACEScg' in warning and 'linear' in warning

    def test_file(self, sync, tmp_path):
        self.textured(self.saved(tmp_path))
        sync.run()
        ((_, _, path, srgb, _),) = sync.recorder.arguments('set_image_file')
        assert path == str(tmp_path / 'saved.png') and srgb

    def test_packed(self, sync, tmp_path):
        image = self.saved(tmp_path)
        image.pack()
        self.textured(image)
        sync.run()
        ((_, _, data, srgb, _),) = sync.recorder.arguments('set_image_encoded')
        assert data.startswith(b'\x89PNG') and srgb

    def test_data_is_not_multiplied_by_alpha(self, sync, tmp_path):
        image = self.saved(tmp_path)
        image.colorspace_settings.name = 'Non-Color'
        self.textured(image)
        sync.run()
        assert sync.recorder.arguments('set_image_file')[0][3:] == (False, 'CHANNEL_PACKED')

    def test_file_that_the_decoder_refuses(self, sync, tmp_path):
        sync.recorder.refuse_files = True
        self.textured(self.saved(tmp_path))
        sync.run()
        assert sync.recorder.names().count('set_image_pixels') == 1

    def test_missing(self, sync, tmp_path):
        image = self.saved(tmp_path)
        (tmp_path / 'saved.png').unlink()
        self.textured(image)
        image.reload()
        _, report = sync.run()
        ((_, _, pixels, _, _),) = sync.recorder.arguments('set_image_pixels')
        assert pixels.tolist() == [[[1, 0, 1, 1]]]
        (warning,) = report.warnings
        assert "'Painted'" in warning and 'saved.png' in warning and 'Find Missing Files' in warning

    def test_file_is_sent_again_when_it_changes(self, sync, tmp_path):
        self.textured(self.saved(tmp_path))
        sync.run()
        assert sync.full()[0] == []
        os.utime(tmp_path / 'saved.png', (1, 1))
        assert sync.full()[0] == ['set_image_file']
