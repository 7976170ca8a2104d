# SPDX-License-Identifier: GPL-3.0-or-later
"""Ranges of samples that are rendered apart: what is in their files, and what merging makes of them."""

import os

import bpy
import numpy as np
import pytest

from panoptes import native
from panoptes.cli import arguments, commands
from panoptes.cli.console import Console
from test_cli import fails_here
from test_engine import ground, lamp, world

oiio = pytest.importorskip('OpenImageIO')


def command(tmp_path, *words):
    """Run a command line in this Blender; return its lines on stderr."""
    log = tmp_path / 'console'
    descriptor = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    try:
        options = arguments.parse([str(word) for word in words])
        commands.COMMANDS[options.command](options, Console(descriptor))
    finally:
        os.close(descriptor)
    lines = log.read_text().splitlines()
    log.unlink()
    return lines


def parts(path):
    """Return {part name: {channel: float32[H, W]}} of an OpenEXR file, in the file's order."""
    source = oiio.ImageInput.open(str(path))
    assert source is not None, oiio.geterror()
    found = {}
    while source.seek_subimage(len(found), 0):
        spec = source.spec()
        pixels = source.read_image(len(found), 0, 0, spec.nchannels, oiio.FLOAT)
        found[spec.getattribute('oiio:subimagename')] = dict(
            zip(spec.channelnames, np.moveaxis(pixels, -1, 0)))
    return found


def assert_same_bits(one, other):
    one, other = parts(one), parts(other)
    assert list(one) == list(other)
    for name, channels in one.items():
        assert list(channels) == list(other[name])
        for channel, pixels in channels.items():
            assert (pixels.view(np.uint32) == other[name][channel].view(np.uint32)).all(), (name, channel)


def textured():
    """Return a material with an image finer than the pixels, and as transparent as its colours."""
    image = bpy.data.images.new('Noise', 64, 64)
    image.pixels.foreach_set(np.random.default_rng(5).random(64 * 64 * 4, np.float32))
    image.pack()
    found = bpy.data.materials.new('Textured')
    found.use_nodes = True
    tree = found.node_tree
    shader = next(node for node in tree.nodes if node.type == 'BSDF_PRINCIPLED')
    texture = tree.nodes.new('ShaderNodeTexImage')
    texture.image = image
    tree.links.new(texture.outputs['Color'], shader.inputs['Base Color'])
    tree.links.new(texture.outputs['Alpha'], shader.inputs['Alpha'])
    return found


@pytest.fixture
def blend(scene, native_module, tmp_path):
    """Return the path of a scene in which every sample differs: soft lamps, texture, transparency."""
    native.use_factory(None)
    scene.render.resolution_x, scene.render.resolution_y = 32, 18
    # Far enough for the maps of the sun to follow what the camera sees.
    ground(400.0)
    bpy.ops.mesh.primitive_cube_add(size=3.0, location=(0.5, 0.0, 1.5), rotation=(0.4, 0.3, 0.2))
    bpy.context.object.data.materials.append(textured())
    lamp('SUN', 2.0).angle = 0.1
    lamp('POINT', 300.0, location=(2.0, -2.0, 5.0)).shadow_soft_size = 0.5
    world((0.1, 0.2, 0.3))
    scene.camera.location = (0.0, -9.0, 4.0)
    scene.camera.rotation_euler = (1.2, 0.0, 0.0)
    scene.panoptes.realtime.shadow_resolution = 256
    return save(tmp_path)


def save(tmp_path):
    path = tmp_path / 'scene.blend'
    bpy.ops.wm.save_as_mainfile(filepath=str(path), check_existing=False)
    return path


@pytest.fixture
def render(blend, tmp_path):
    """Return a function that renders a range of samples to an .exr and gives its path."""

    def run(samples, *options, name=None, warnings=0):
        path = tmp_path / (name or samples.replace(':', '-') + '.exr')
        lines = command(tmp_path, 'render', blend, '-o', path, '--samples', samples, *options)
        assert len(lines) == warnings, lines
        return path

    return run


@pytest.mark.parametrize('method, cuts', [('realtime', (0, 5, 24, 40)), ('primitive', (0, 3, 18, 20))])
def test_ranges_merge_to_the_bits_of_one_render(render, tmp_path, method, cuts):
    whole = render(f'{cuts[0]}:{cuts[-1]}', '--method', method)
    ranges = [render(f'{first}:{last}', '--method', method) for first, last in zip(cuts, cuts[1:])]
    picture = parts(whole)['picture']
    assert picture['ViewLayer.Combined.R'].std() > 0.01 and 'ViewLayer.DiffDir.G' in picture
    assert any((parts(ranges[0])['picture'][name] != pixels).any() for name, pixels in picture.items())

    merged = tmp_path / 'merged.exr'
    # In any order.
    assert command(tmp_path, 'merge', merged, ranges[2], ranges[0], ranges[1]) == []
    assert_same_bits(merged, whole)
    # Step by step, over one of the files themselves.
    assert command(tmp_path, 'merge', ranges[1], ranges[1], ranges[2]) == []
    assert command(tmp_path, 'merge', merged, ranges[0], ranges[1]) == []
    assert_same_bits(merged, whole)
    leftover = [path.name for path in tmp_path.iterdir() if path.suffix not in ('.exr', '.blend')]
    assert leftover == []


def test_pieces_are_behind_a_picture_that_blender_opens(render):
    plain = parts(render('20', name='plain.exr'))
    assert len(plain) == 1
    ranged = render('3:20')
    found = parts(ranged)
    assert list(found)[0] == 'picture' and list(found['picture']) == list(*plain.values())
    assert list(found)[1:] == [f'layer 1 samples {i}-{i + 1}' for i in range(3, 16)] + [
        'layer 1 samples 16-20']
    # Depth is no sum: only the first piece has it.
    assert [name for name, channels in found.items() if f'{name}.Depth.Z' in channels] == [
        'layer 1 samples 3-4']
    image = bpy.data.images.load(str(ranged))
    assert tuple(image.size) == (0, 0)  # this reads the file, whose layers have the sizes
    assert image.type == 'MULTILAYER'


def test_view_layers_are_merged_each(scene, blend, render, tmp_path):
    bpy.ops.wm.open_mainfile(filepath=str(blend))
    bpy.context.scene.view_layers.new('Another.Layer')
    save(tmp_path)
    whole, first, second = render('0:4'), render('0:1'), render('1:4')
    merged = tmp_path / 'merged.exr'
    assert command(tmp_path, 'merge', merged, first, second) == []
    assert_same_bits(merged, whole)
    assert {name.split('.Combined')[0] for name in parts(merged)['picture'] if '.Combined.' in name} == {
        'ViewLayer', 'Another.Layer'}


def test_what_does_not_fit_is_refused_in_one_sentence(render, tmp_path):
    start, target = render('0:2'), tmp_path / 'merged.exr'
    target.write_bytes(b'mine')

    def refused(*files, says):
        fails_here('merge', target, *files, says=says)

    refused(start, render('3:4'), says='Samples 2:3 are missing')
    refused(start, render('1:4'), says="Samples 1:2 are in '")
    refused(start, start, says='Samples 0:2 are in')
    refused(start, render('2:4', '--seed', '7'), says='another seed than')
    refused(start, render('2:4', '--size', '16x16'), says='another camera, height, width than')
    refused(start, render('2:4', '--frame', '3'), says='another frame than')
    refused(start, render('2', name='plain.exr'), says='holds no pieces')
    refused(start, tmp_path / 'gone.exr', says='There is no file')
    refused(start, tmp_path / 'scene.blend', says='cannot be read')
    cut = tmp_path / 'cut.exr'
    cut.write_bytes(start.read_bytes()[:-3000])
    refused(cut, says='cannot be read')
    fails_here('merge', tmp_path / 'merged.png', start, says='.exr')
    assert target.read_bytes() == b'mine'
    assert not list(tmp_path.glob('.*'))


def test_pictures_that_cannot_be_merged_are_written_with_a_warning(render, blend, tmp_path):
    noisy = render('0:2', '--noise-threshold', '0.5', warnings=1)
    assert len(parts(noisy)) == 1
    bpy.ops.wm.open_mainfile(filepath=str(blend))
    border = bpy.context.scene.render
    border.use_border, border.border_max_x, border.use_crop_to_border = True, 0.5, False
    save(tmp_path)
    region = render('0:1', warnings=1)
    assert len(parts(region)) == 1
