# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line in a Blender of its own: good input, bad input, exit statuses, files."""

import json
import os
import re
import subprocess

import bpy
import pytest

from panoptes.cli import arguments, commands
from panoptes.cli.console import Console
from panoptes.cli.failure import BadCommandLine, Failure

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
MAIN = os.path.join(ROOT, 'addon', 'panoptes', 'cli', 'main.py')


def run(*words, environment=None):
    """Run the command line; return (exit status, lines on stderr of our own, all output)."""
    read, write = os.pipe()
    variables = {**os.environ, 'PANOPTES_STDERR_FD': str(write), **(environment or {})}
    with subprocess.Popen(
            [bpy.app.binary_path, '-b', '--factory-startup', '--python-exit-code', '1', '-P', MAIN,
             '--', *map(str, words)],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, pass_fds=[write], env=variables,
            text=True) as process:
        os.close(write)
        output = process.communicate(timeout=300)[0]
    with os.fdopen(read, encoding='utf-8') as pipe:
        lines = pipe.read().splitlines()
    return process.returncode, lines, output


def fails(*words, says, status=1, environment=None):
    """Run a command line that must fail with one line that contains `says`."""
    found, lines, output = run(*words, environment=environment)
    assert found == status, output
    assert len(lines) == 1 and lines[0].startswith('panoptes: ') and says in lines[0], lines
    # Blender's own add-ons may fail in a small installation; ours may not.
    assert not re.search(r'File ".*/panoptes/.*", line', output), output


def fails_here(*words, says):
    """Like `fails`, without starting a Blender for it."""
    console = Console(os.open(os.devnull, os.O_WRONLY))
    with pytest.raises(Failure) as caught:
        options = arguments.parse([str(word) for word in words])
        commands.COMMANDS[options.command](options, console)
    text = str(caught.value)
    assert says in text and '\n' not in text
    return caught.value


@pytest.fixture
def make(scene, tmp_path):
    """Return a function that saves the present scene and gives its path."""

    def save(name='scene.blend'):
        path = tmp_path / name
        bpy.ops.wm.save_as_mainfile(filepath=str(path), check_existing=False)
        return path

    return save


class TestBadCommandLines:
    """Mistakes that need no file: exit status 2."""

    def test_no_command(self):
        fails(says='command', status=2)

    def test_unknown_option(self):
        error = fails_here('render', 'a.blend', '-o', 'a.png', '--quality', '3', says='--quality')
        assert isinstance(error, BadCommandLine)

    def test_unknown_method(self):
        fails_here('render', 'a.blend', '-o', 'a.png', '--method', 'magic', says='magic')

    @pytest.mark.parametrize('option, value', [
        ('--samples', 'many'), ('--samples', '5:5'), ('--samples', '0'), ('--size', '640'),
        ('--size', '0x480'), ('--bounces', '-1'), ('--seed', 'x'), ('--time-budget', '-3'),
        ('--noise-threshold', 'nan'), ('--frame', '1.5'), ('--set', 'samples')])
    def test_bad_value(self, option, value):
        fails_here('render', 'a.blend', '-o', 'a.png', f'{option}={value}', says=option)

    def test_unknown_format(self):
        fails_here('render', 'a.blend', '-o', 'a.jpg', says='.png or .exr')

    def test_help(self):
        status, lines, _ = run('render', '--help')
        assert status == 0 and any('--noise-threshold' in line for line in lines)


class TestBadFiles:
    """One sentence, the right exit status, no file."""

    def test_missing_file(self, tmp_path):
        fails('render', tmp_path / 'none.blend', '-o', tmp_path / 'out.png', says='There is no file')

    def test_not_a_blend(self, tmp_path):
        (tmp_path / 'text.blend').write_text('Hello')
        fails_here('render', tmp_path / 'text.blend', '-o', tmp_path / 'out.png',
                   says='is not a .blend file')

    def test_damaged_blend(self, tmp_path):
        (tmp_path / 'damaged.blend').write_bytes(b'BLENDER-v304' + bytes(100))
        fails('render', tmp_path / 'damaged.blend', '-o', tmp_path / 'out.png', says='cannot open')

    def test_folder(self, tmp_path):
        fails_here('render', tmp_path, '-o', tmp_path / 'out.png', says='is a folder')

    def test_no_camera(self, scene, make, tmp_path):
        scene.camera = None
        fails('render', make(), '-o', tmp_path / 'out.png', says='has no camera')
        assert not (tmp_path / 'out.png').exists()

    def test_missing_output_folder(self, make, tmp_path):
        fails_here('render', make(), '-o', tmp_path / 'none' / 'out.png', says='There is no folder')

    @pytest.mark.skipif(not os.path.ismount('/proc'), reason='root may write everywhere else')
    def test_output_folder_that_cannot_be_written(self, make):
        fails('render', make(), '-o', '/proc/out.png', says='/proc')

    def test_unknown_key(self, make, tmp_path):
        fails_here('render', make(), '-o', tmp_path / 'out.png', '--set', 'colour=1',
                   says="'colour' is not an option")

    @pytest.mark.parametrize('assignment', ['samples=many', 'samples=0', 'method=magic',
                                            'realtime.shadow_resolution=1', 'force_all_effects=2'])
    def test_bad_assignment(self, make, tmp_path, assignment):
        fails_here('render', make(), '-o', tmp_path / 'out.png', '--set', assignment,
                   says=assignment.split('=')[0])

    def test_size_that_blender_cannot_render(self, make, tmp_path):
        fails_here('render', make(), '-o', tmp_path / 'out.png', '--size', '1x1', says='1x1')


@pytest.mark.usefixtures('native_module')
class TestRenders:
    """Files that come out."""

    def test_png(self, make, tmp_path):
        status, lines, output = run('render', make(), '-o', tmp_path / 'out.png', '--size', '40x30',
                                    '--stats', tmp_path / 'out.json')
        assert status == 0 and lines == [], output
        assert (tmp_path / 'out.png').read_bytes().startswith(b'\x89PNG')
        stats = json.loads((tmp_path / 'out.json').read_text())
        assert stats['size'] == [40, 30] and stats['samples'] == 1
        for key in ('device', 'effects', 'passes', 'sync_ms', 'build_ms', 'trace_ms', 'total_ms',
                    'rays', 'cache', 'memory_bytes', 'estimated_error', 'warnings'):
            assert key in stats
        assert all({'name', 'runs', 'reason', 'ms'} <= set(effect) for effect in stats['effects'])
        assert sorted(p.name for p in tmp_path.iterdir()) == ['out.json', 'out.png', 'scene.blend']

    def test_exr(self, make, tmp_path):
        oiio = pytest.importorskip('OpenImageIO')
        status, _, output = run('render', make(), '-o', tmp_path / 'out.exr')
        assert status == 0, output
        spec = oiio.ImageInput.open(str(tmp_path / 'out.exr')).spec()
        names = {name.split('.', 1)[1] for name in spec.channelnames}
        assert {'Combined.R', 'Combined.A', 'Depth.Z', 'Normal.X', 'DiffCol.R', 'DiffDir.B',
                'GlossCol.R', 'GlossDir.G', 'Emit.R', 'Env.B'} <= names
        assert spec.format == oiio.FLOAT

    def test_options_and_assignments(self, make, tmp_path):
        status, lines, output = run(
            'render', make(), '-o', tmp_path / 'out.png', '--samples', '2:5', '--seed', '7',
            '--bounces', '3', '--frame', '4', '--force-all-effects', '--noise-threshold', '0.5',
            '--time-budget', '60', '--method', 'realtime', '--set', 'realtime.shadow_resolution=256',
            '--set', 'realtime.soft_shadows=off', '--set', 'ambient_occlusion.estimator=HBAO',
            '--stats', tmp_path / 'out.json')
        assert status == 0, output
        assert lines == []
        assert 1 <= json.loads((tmp_path / 'out.json').read_text())['samples'] <= 3

    def test_fragment_tracing(self, make, tmp_path):
        status, lines, _ = run('render', make(), '-o', tmp_path / 'out.png', '--method', 'fragment', '--set',
                               'fragment.side=64', '--set', 'fragment.storage=SB', '--stats', tmp_path / 'out.json')
        assert status == 0 and lines == []
        passes = [entry['name'] for entry in json.loads((tmp_path / 'out.json').read_text())['passes']]
        assert 'structure_links' in passes and 'path_rays' in passes

    def test_missing_texture(self, scene, make, tmp_path):
        material = bpy.data.materials.new('Painted')
        material.use_nodes = True
        tree = material.node_tree
        texture = tree.nodes.new('ShaderNodeTexImage')
        image = bpy.data.images.new('Lost', 4, 4)
        image.source, image.filepath = 'FILE', '//lost.png'
        texture.image = image
        node = next(n for n in tree.nodes if n.type == 'BSDF_PRINCIPLED')
        tree.links.new(texture.outputs[0], node.inputs['Base Color'])
        bpy.ops.mesh.primitive_plane_add()
        bpy.context.object.data.materials.append(material)
        status, lines, output = run('render', make(), '-o', tmp_path / 'out.png', '--stats',
                                    tmp_path / 'out.json')
        assert status == 0, output
        assert len(lines) == 1 and 'warning' in lines[0], lines
        assert "'Painted'" in lines[0] and 'lost.png' in lines[0]
        assert len(json.loads((tmp_path / 'out.json').read_text())['warnings']) == 1

    def test_existing_file_survives_a_failure(self, scene, make, tmp_path):
        (tmp_path / 'out.png').write_bytes(b'mine')
        for layer in scene.view_layers:
            layer.use = False
        status, lines, _ = run('render', make(), '-o', tmp_path / 'out.png')
        assert status == 1 and len(lines) == 1
        assert (tmp_path / 'out.png').read_bytes() == b'mine'
        assert sorted(p.name for p in tmp_path.iterdir()) == ['out.png', 'scene.blend']

    def test_snapshot(self, make, tmp_path):
        status, lines, output = run('snapshot', make(), '-o', tmp_path / 'out.scene')
        assert status == 0 and lines == [], output
        assert (tmp_path / 'out.scene').stat().st_size > 0

    def test_no_driver(self, make, tmp_path):
        fails('render', make(), '-o', tmp_path / 'out.png', says='driver',
              environment={'__EGL_VENDOR_LIBRARY_FILENAMES': '/nonexistent'})
        assert not (tmp_path / 'out.png').exists()

    def test_background_render_without_the_command_line(self, make, tmp_path):
        path = make()
        code = ('import sys; sys.path.insert(0, %r); import panoptes; panoptes.register(); '
                'import bpy; bpy.context.scene.render.filepath = %r; '
                'bpy.context.scene.render.image_settings.file_format = "PNG"; '
                'bpy.ops.render.render(write_still=True); '
                'assert bpy.context.scene.panoptes.last_stats'
                % (os.path.join(ROOT, 'addon'), str(tmp_path / 'f12.png')))
        done = subprocess.run(
            [bpy.app.binary_path, '-b', '--factory-startup', '--python-exit-code', '1', str(path),
             '--python-expr', code], capture_output=True, text=True, timeout=300, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
        assert (tmp_path / 'f12.png').exists()


def test_console_without_a_reader():
    """A closed stderr stops nothing."""
    read, write = os.pipe()
    os.close(read)
    console = Console(write)
    console.warning('Nobody reads this.')
    console.progress(0.5, 'nor this')
    os.close(write)
