# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels, node menus and the operator: what the artist is offered when Panoptes is the engine."""

import json
import re
import types

import addon_utils
import bpy
import pytest

import panoptes
from panoptes import compat, honoured, session


def panels():
    """Yield every panel class that lists engines."""
    waiting = [bpy.types.Panel]
    while waiting:
        for panel in waiting.pop().__subclasses__():
            waiting.append(panel)
            if hasattr(panel, 'COMPAT_ENGINES'):
                yield panel


def honoured_names():
    return {panel.__name__ for panel in panels() if 'PANOPTES' in panel.COMPAT_ENGINES}


class Layout:
    """Stands for a UILayout and notes the properties that are drawn."""

    def __init__(self, drawn=None):
        self.drawn = drawn if drawn is not None else []

    def prop(self, owner, name, **_):
        assert hasattr(owner, name), f'{owner} has no {name}'
        self.drawn.append(name)

    def operator(self, name, **_):
        self.drawn.append(name)

    def label(self, text='', **_):
        self.drawn.append(text)

    def template_node_view(self, tree, node, socket):
        self.drawn.append(socket.name)

    def template_preview(self, data):
        self.drawn.append(data.name)

    def separator(self):
        """Nothing to note."""

    def row(self, **_):
        return Layout(self.drawn)

    column = row


def draw(panel, **context):
    """Return what a panel of ours draws in a context."""
    context = types.SimpleNamespace(engine='PANOPTES', scene=bpy.context.scene,
                                    view_layer=bpy.context.view_layer, **context)
    cls = getattr(bpy.types, panel)
    assert cls.poll(context)
    layout = Layout()
    stand_in = types.SimpleNamespace(layout=layout)
    stand_in._column = types.MethodType(cls._column, stand_in)
    stand_in._sentences = getattr(cls, '_sentences', None)
    cls.draw(stand_in, context)
    return layout.drawn


class TestBlendersPanels:
    """Which of Blender's own panels appear."""

    @pytest.mark.parametrize('name', [
        'DATA_PT_lens', 'DATA_PT_camera', 'DATA_PT_camera_dof_aperture', 'EEVEE_MATERIAL_PT_surface', 'EEVEE_WORLD_PT_surface',
        'RENDER_PT_format', 'RENDER_PT_color_management', 'RENDER_PT_simplify', 'PHYSICS_PT_cloth',
        'PARTICLE_PT_emission', 'DATA_PT_uv_texture', 'MATERIAL_PT_preview',
        'TEXTURE_PT_context', 'RENDER_PT_freestyle', 'VIEWLAYER_PT_layer'])
    def test_offered(self, name):
        assert name in honoured_names()

    @pytest.mark.parametrize('pattern', [
        r'CYCLES_', r'RENDER_PT_(eevee|opengl)', r'DATA_PT_EEVEE',
        r'EEVEE_WORLD_PT_(?!surface)', r'EEVEE_(NEXT_)?MATERIAL_PT_(volume|displacement|settings)',
        r'stereo', r'lightprobe_', r'layer_passes', r'DATA_PT_area$', r'OBJECT_PT_(shading|visibility)'])
    def test_what_does_not_count_is_not_offered(self, pattern):
        offered = [name for name in honoured_names() if re.search(pattern, name)
                   and not name.startswith('PANOPTES')]
        assert not offered

    def test_no_panel_hangs_on_one_that_is_not_offered(self):
        """Blender draws a sub-panel below its parent only."""
        named = {getattr(panel, 'bl_idname', panel.__name__): panel for panel in panels()}
        lost = [panel.__name__ for panel in named.values() if 'PANOPTES' in panel.COMPAT_ENGINES
                and 'PANOPTES' not in getattr(named.get(getattr(panel, 'bl_parent_id', None)),
                                              'COMPAT_ENGINES', {'PANOPTES'})]
        assert not lost

    def test_every_reason_names_a_panel_of_some_version(self):
        """In this version at least most of the names must exist; a typing error hides nothing else."""
        names = {panel.__name__ for panel in panels()}
        unknown = [start for start, _ in honoured._IGNORED
                   if not any(name.startswith(start) for name in names)]
        new, old = {'OBJECT_PT_shading', 'OBJECT_PT_shadow_terminator'}, {'DATA_PT_area',
                                                                          'DATA_PT_falloff_curve'}
        assert set(unknown) <= new | old

    def test_nothing_stays_behind(self):
        panoptes.unregister()
        try:
            ours = {name for name in honoured_names() if not name.startswith('PANOPTES')}
        finally:
            panoptes.register()
        assert not ours and len(honoured_names()) > 100


class TestNodeMenu:
    """The Add menu of the node editor."""

    @staticmethod
    def offered(engine):
        """Return the types of node that the menu shows for a material."""
        import nodeitems_builtins

        space = types.SimpleNamespace(tree_type='ShaderNodeTree', shader_type='OBJECT', edit_tree=None)
        context = types.SimpleNamespace(engine=engine, space_data=space)
        items = (item for category in nodeitems_builtins.shader_node_categories
                 for item in category.items(context))
        return {item.nodetype for item in items
                if hasattr(item, 'nodetype') and (item.poll is None or item.poll(context))}

    @pytest.mark.skipif(compat.VERSION >= (4, 0, 0), reason='later menus only ask for EEVEE')
    def test_shader_nodes_are_offered(self):
        offered = {engine: self.offered(engine) for engine in ('PANOPTES', 'CYCLES', 'OTHER')}
        assert 'ShaderNodeBsdfPrincipled' in offered['PANOPTES']
        assert offered['PANOPTES'] == offered['CYCLES'] > offered['OTHER']


class TestOurPanels:
    """Every panel of ours draws properties that exist."""

    def test_render(self, scene):
        scene.panoptes.last_stats = ('{"device": "some", "samples": 2, "total_ms": 1500.0, "effects": '
                                     '[{"name": "lamps", "runs": false, "reason": "no lamps"}], '
                                     '"warnings": []}')
        assert 'lamps: no lamps' in draw('PANOPTES_PT_statistics')
        assert 'exposure' in draw('PANOPTES_PT_film')
        assert 'samples' in draw('PANOPTES_PT_sampling')
        assert 'seed' in draw('PANOPTES_PT_sampling_limits')
        assert 'penumbrae' in draw('PANOPTES_PT_shadows')
        scene.panoptes.realtime.soft_shadows = False
        assert draw('PANOPTES_PT_shadows') == ['shadow_resolution', 'soft_shadows']
        assert 'use_pass_z' in draw('PANOPTES_PT_passes')
        assert draw('PANOPTES_PT_take_over') == ['panoptes.take_over_cycles']

    def test_what_counts_for_paths_only(self, scene):
        context = types.SimpleNamespace(engine='PANOPTES', scene=scene)
        ours = [getattr(bpy.types, f'PANOPTES_PT_{name}')
                for name in ('light_paths', 'light_path_kinds', 'clamping', 'rays')]
        assert not any(panel.poll(context) for panel in ours)
        assert 'use_pass_position' not in draw('PANOPTES_PT_passes')
        scene.panoptes.debug_picture = 'steps'
        assert 'structure' in draw('PANOPTES_PT_debug')
        scene.panoptes.method = 'primitive'
        drawn = [name for panel in ours for name in draw(panel.__name__)]
        settings = {p.identifier for p in scene.panoptes.primitive.bl_rna.properties} - {'rna_type', 'name'}
        # Every setting of paths is offered, once; those of a structure where it is one with tiles.
        assert sorted(drawn) == sorted(settings - {'tiles', 'buckets'} | {'bounces'})
        assert draw('PANOPTES_PT_debug') == ['debug_picture']
        scene.panoptes.primitive.structure = 'cube'
        assert 'tiles' in draw('PANOPTES_PT_rays')
        assert {'use_pass_position', 'use_pass_sample_count'} <= set(draw('PANOPTES_PT_passes'))

    def test_warnings_are_wrapped(self, scene):
        room = {'region': types.SimpleNamespace(width=300), 'preferences': types.SimpleNamespace(
            system=types.SimpleNamespace(ui_scale=1.0))}
        assert not bpy.types.PANOPTES_PT_warnings.poll(bpy.context)
        long = 'A very long sentence about a thing that cannot be shown as the scene asks for it.'
        scene.panoptes.last_stats = json.dumps({'warnings': ['It is late.', long]})
        drawn = draw('PANOPTES_PT_warnings', **room)
        assert drawn[0] == 'It is late.' and len(drawn) > 2 and ' '.join(drawn[1:]) == long

    @pytest.mark.parametrize('kind', ['POINT', 'SUN', 'SPOT', 'AREA'])
    def test_light(self, scene, kind):
        light = bpy.data.lights.new('Lamp', kind)
        drawn = draw('PANOPTES_PT_light', light=light)
        assert {'color', 'energy', 'use_shadow'} <= set(drawn)
        assert ('spread' in drawn) == (kind == 'AREA') and ('angle' in drawn) == (kind == 'SUN')
        # Every switch that takes the shadow away is in the panel.
        for owner, name, _ in compat.light_shadow_switches(light):
            setattr(owner, name, False)
            assert not compat.light_casts_shadow(light) and name in drawn
            setattr(owner, name, True)
        assert compat.light_casts_shadow(light)

    def test_light_nodes(self, scene):
        light = bpy.data.lights.new('Lamp', 'POINT')
        if not compat.uses_nodes(light):
            assert draw('PANOPTES_PT_light_nodes', light=light) == ['use_nodes']
            light.use_nodes = True
        assert draw('PANOPTES_PT_light_nodes', light=light) == ['Surface']

    def test_object_and_world(self, scene):
        thing = bpy.data.objects.new('Thing', bpy.data.meshes.new('Mesh'))
        assert 'hide_render' in draw('PANOPTES_PT_visibility', object=thing)
        assert 'visible_volume_scatter' in draw('PANOPTES_PT_ray_visibility', object=thing)
        world = bpy.data.worlds.new('World')
        assert draw('PANOPTES_PT_world_preview', world=world) == ['World']


@pytest.fixture
def cycles(scene):
    """Cycles' settings of the scene, far from their defaults."""
    found = scene.cycles
    found.samples, found.preview_samples, found.seed = 77, 33, 5
    found.use_adaptive_sampling, found.adaptive_threshold = True, 0.125
    found.time_limit, found.max_bounces = 9.0, 3
    found.film_exposure, found.filter_width = 2.5, 3.0
    return found


class TestTakingOver:
    """The operator `panoptes.take_over_cycles`."""

    def test_values(self, scene, cycles):
        assert bpy.ops.panoptes.take_over_cycles() == {'FINISHED'}
        ours = scene.panoptes
        assert (ours.samples, ours.viewport_samples, ours.seed, ours.bounces) == (77, 33, 5, 3)
        assert (ours.noise_threshold, ours.time_budget, ours.exposure) == (0.125, 9.0, 2.5)
        assert scene.render.filter_size == 3.0

    def test_limits_by_kind(self, scene, cycles):
        scene.panoptes.radiance_cache.bounces = 8
        cycles.diffuse_bounces, cycles.glossy_bounces, cycles.transmission_bounces = 1, 2, 5
        cycles.transparent_max_bounces = 6
        cycles.sample_clamp_direct, cycles.sample_clamp_indirect, cycles.blur_glossy = 7.0, 4.0, 0.5
        scene.view_layers[0].cycles.pass_debug_sample_count = True
        bpy.ops.panoptes.take_over_cycles()
        ours = scene.panoptes.primitive
        assert (ours.diffuse_bounces, ours.glossy_bounces, ours.transmission_bounces) == (1, 2, 5)
        assert (ours.transparent_bounces, ours.clamp_direct, ours.clamp_indirect) == (6, 7.0, 4.0)
        assert ours.filter_glossy == 0.5 and scene.view_layers[0].panoptes.use_pass_sample_count
        assert scene.panoptes.radiance_cache.bounces == 1

    def test_no_adaptive_sampling_is_no_threshold(self, scene, cycles):
        cycles.use_adaptive_sampling = False
        scene.panoptes.noise_threshold = 0.5
        bpy.ops.panoptes.take_over_cycles()
        assert scene.panoptes.noise_threshold == 0.0

    def test_report_is_one_sentence(self, scene, cycles, capfd):
        cycles.pixel_filter_type, cycles.use_fast_gi = 'BOX', True
        bpy.ops.panoptes.take_over_cycles()
        (line,) = [text for text in capfd.readouterr().out.splitlines() if 'Taken over' in text]
        taken, missing = line.split('; ')
        assert 'clamping' in taken and 'exposure' in taken
        assert 'Box filter' in missing and 'fast GI' in missing
        assert line.rstrip().endswith('.')

    def test_absurd_values_can_be_rendered(self, scene, cycles, recorder):
        cycles.preview_samples, cycles.film_exposure, cycles.filter_width = 0, 10.0, 10.0
        bpy.ops.panoptes.take_over_cycles()
        bpy.ops.render.render()
        assert scene.panoptes.viewport_samples == 1 and not session.last_error

    def test_without_the_add_on(self, scene, capfd):
        addon_utils.disable('cycles')
        try:
            assert bpy.ops.panoptes.take_over_cycles() == {'CANCELLED'}
        finally:
            addon_utils.enable('cycles')
        assert 'Cycles add-on is disabled' in capfd.readouterr().out
