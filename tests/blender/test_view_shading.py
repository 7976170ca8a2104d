# SPDX-License-Identifier: GPL-3.0-or-later
"""What each 3D View shows and writes: its menu, its requests, and the text in its corner."""

import types

import bpy
import numpy as np
import pytest
from mathutils import Matrix

import panoptes
from panoptes import changeover, overlay, passes, requests, session, user_interface, view_shading
from panoptes.refinement import Refinement


def space(**shading):
    """Return a stand-in for a 3D View in Rendered shading."""
    ours = types.SimpleNamespace(**{'render_pass': 'COMBINED', 'show_statistics': True, **shading})
    return types.SimpleNamespace(
        use_render_border=False, shading=types.SimpleNamespace(type='RENDERED', panoptes=ours),
        overlay=types.SimpleNamespace(show_overlays=True))


def request(identifier):
    """Return the request of a 3D View that shows an entry of the menu."""
    region = types.SimpleNamespace(width=64, height=32)
    looking = types.SimpleNamespace(view_perspective='PERSP', view_matrix=Matrix(), window_matrix=Matrix())
    view, depsgraph = space(render_pass=identifier), bpy.context.evaluated_depsgraph_get()
    shown = view_shading.shown(bpy.context.scene, view)
    return requests.viewport(depsgraph, region, looking, view, 1, pytest.fail, shown)[0]


def preferences(scale):
    """Return the preferences of a user whose interface is scaled; its letters are 11 high."""
    style = types.SimpleNamespace(widget=types.SimpleNamespace(points=11))
    return types.SimpleNamespace(system=types.SimpleNamespace(ui_scale=scale), ui_styles=[style],
                                 themes=bpy.context.preferences.themes)


class TestMenu:
    """The entries, and where they are kept."""

    def test_each_view_has_its_own(self):
        areas = [a for screen in bpy.data.screens for a in screen.areas if a.type == 'VIEW_3D']
        shadings = [a.spaces[0].shading for a in areas][:2]
        assert shadings[0].panoptes.render_pass == 'COMBINED' and not shadings[0].panoptes.show_statistics
        shadings[0].panoptes.render_pass = 'NORMAL'
        try:
            assert shadings[1].panoptes.render_pass == 'COMBINED'
        finally:
            shadings[0].panoptes.render_pass = 'COMBINED'

    def test_entries_are_passes(self):
        names = {entry.name for entry in passes.filled_by('realtime')}
        assert {entry.name for entry in view_shading.VIEW_PASSES} <= names
        found = view_shading.PanoptesViewShading.bl_rna.properties['render_pass'].enum_items.keys()
        assert list(found) == [entry.identifier for entry in view_shading.VIEW_PASSES]

    def test_panel_is_for_rendered_views_of_ours(self):
        # Also when the add-on was switched off and on again, which takes the engine out of Blender's panels.
        user_interface.unregister()
        user_interface.register()
        poll = view_shading.PANOPTES_PT_view_pass.poll
        view = space()
        assert poll(types.SimpleNamespace(engine='PANOPTES', space_data=view))
        assert not poll(types.SimpleNamespace(engine='CYCLES', space_data=view))
        view.shading.type = 'MATERIAL'
        assert not poll(types.SimpleNamespace(engine='PANOPTES', space_data=view))

    def test_panel_hangs_on_one_of_blenders(self):
        assert hasattr(bpy.types, view_shading.PANOPTES_PT_view_pass.bl_parent_id)

    def test_nothing_stays_behind(self):
        panoptes.unregister()
        try:
            assert not hasattr(bpy.types.View3DShading, 'panoptes')
            assert not hasattr(bpy.types, 'PANOPTES_PT_view_pass') and overlay._handle is None
        finally:
            panoptes.register()
        assert hasattr(bpy.types.View3DShading, 'panoptes')


class TestRequest:
    """What is asked of the native engine."""

    def test_combined_is_what_it_was(self, scene):
        found = request('COMBINED')
        assert found['passes'] == ['Combined'] and 'shown_pass' not in found

    @pytest.mark.parametrize('entry', view_shading.VIEW_PASSES[1:], ids=lambda entry: entry.identifier)
    def test_pass_is_asked_for(self, scene, entry):
        found = request(entry.identifier)
        assert found['passes'] == ['Combined', entry.name] and found['shown_pass'] == entry.name

    @pytest.mark.parametrize(('identifier', 'stages'), [
        ('NORMAL', 1), ('DIFFUSE_COLOR', 1), ('EMISSION', 1), ('ENVIRONMENT', 1), ('DIFFUSE_DIRECT', 2),
        ('DIFFUSE_INDIRECT', 2), ('AO', 2)])
    def test_paths_take_over_where_light_counts(self, scene, identifier, stages):
        scene.panoptes.method = 'primitive'
        found = request(identifier)
        assert found['method'] == ('primitive' if stages == 2 else 'realtime')
        kind = changeover.Changeover if stages == 2 else Refinement
        assert isinstance(changeover.picture(found, 'key'), kind)

    def test_debug_pictures_come_first(self, scene):
        scene.panoptes.debug_picture = 'occlusion_multiview'
        assert 'shown_pass' not in request('NORMAL')

    def test_native_engine_knows_all(self, scene, native_module):
        engine = native_module.Engine()
        try:
            for entry in view_shading.VIEW_PASSES:
                job = engine.render({**request(entry.identifier), 'samples': (0, 1)})
                assert job.wait(60.0)
                job.finish()
                pixels = job.read('Combined')
                assert pixels.shape == (32, 64, 4) and np.isfinite(pixels).all()
        finally:
            engine.close()


class TestOverlay:
    """The text in the corner."""

    @pytest.mark.parametrize(('change', 'wanted'), [
        (lambda view: None, True),
        (lambda view: setattr(view.overlay, 'show_overlays', False), False),
        (lambda view: setattr(view.shading.panoptes, 'show_statistics', False), False),
        (lambda view: setattr(view.shading, 'type', 'SOLID'), False)])
    def test_switches(self, change, wanted):
        view = space()
        change(view)
        assert overlay.wants_text(view) == wanted

    def test_free_corner(self):
        def region(kind, x, y, width, height):
            return types.SimpleNamespace(type=kind, x=x, y=y, width=width, height=height)

        window = region('WINDOW', 100, 50, 800, 600)
        assert overlay.free_corner(window, [window]) == (0, 0)
        # A header above, a side bar on the right, and what is closed are not in the way.
        others = [region('HEADER', 100, 624, 800, 26), region('UI', 700, 50, 200, 600),
                  region('TOOLS', 100, 50, 1, 600)]
        assert overlay.free_corner(window, others) == (0, 0)
        others += [region('TOOLS', 100, 50, 60, 600), region('HEADER', 100, 50, 800, 26)]
        assert overlay.free_corner(window, others) == (60, 26)
        # Regions that do not overlap stand beside.
        assert overlay.free_corner(window, [region('TOOLS', 40, 50, 60, 600)]) == (0, 0)

    def test_draws_the_text_of_its_region(self, monkeypatch):
        drawn = []
        monkeypatch.setattr(overlay.compat, 'draw_text', lambda *arguments: drawn.append(arguments))
        views = [types.SimpleNamespace(region=address, drawn=when,
                                       statistics=lambda letters, when=when: [f'drawn at {when}'])
                 for address, when in ((7, 1.0), (7, 3.0), (7, 2.0), (8, 9.0))]
        monkeypatch.setattr(session, 'viewports', views)
        region = types.SimpleNamespace(x=0, y=0, width=400, height=300, type='WINDOW', as_pointer=lambda: 7)
        context = types.SimpleNamespace(
            engine='PANOPTES', space_data=space(), region=region, preferences=preferences(2.0),
            area=types.SimpleNamespace(regions=[region]))
        overlay._draw(context)
        ((lines, left, bottom, size, _, color),) = drawn
        assert lines == ['drawn at 3.0'] and left == bottom == size == 22.0 and len(color) == 3
        context.engine = 'CYCLES'
        overlay._draw(context)
        assert len(drawn) == 1

    def test_other_themes_have_white_text(self):
        theme = types.SimpleNamespace(view_3d=types.SimpleNamespace())
        assert overlay.compat.view_text_color(types.SimpleNamespace(themes=[theme])) == (1.0, 1.0, 1.0)
        ours = bpy.context.preferences.themes[0].view_3d.space.text_hi
        assert overlay.compat.view_text_color(bpy.context.preferences) == tuple(ours)

    def test_never_raises_and_tells_once(self, monkeypatch, capfd):
        def fail(context):
            raise ValueError('broken on purpose')

        monkeypatch.setattr(overlay, '_failure', '')
        monkeypatch.setattr(overlay, '_draw', fail)
        for _ in range(3):
            overlay.draw()
        assert capfd.readouterr().err.count('Traceback') == 1

    def test_never_raises_without_a_view(self, monkeypatch, capfd):
        monkeypatch.setattr(overlay, '_failure', '')
        # Without a window there is no 3D View at all.
        overlay.draw()
        capfd.readouterr()
