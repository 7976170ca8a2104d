# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures that refine and go on; whose turn it is among several 3D Views; when a scene is the same."""

import bpy
import numpy as np
import pytest

from building import Sync, add_object, quad
from panoptes import changeover
from panoptes.refinement import Refinement, Turns
from recorder import Recorder


class SlowJob:
    """A job whose samples come when the test says so; sample k is a picture of the number k.

    Real-time's pictures are 100 less.
    """

    def __init__(self, request):
        self.first, self.last = request['samples']
        self.request = request
        self.method = request.get('method')
        self.done = 0
        self.stopped = False
        self.looked = False

    def samples_ready(self):
        return self.done

    def has_look(self):
        return self.done > 0 or self.looked

    def first_sample_seconds(self):
        return 0.25 if self.done else 0.0

    def wait(self, seconds):
        return self.stopped or self.done == self.last - self.first

    def read(self, name):
        mean = np.arange(self.first, self.first + self.done).mean() if self.done else -1.0
        return np.full((2, 3, 4), mean - 100.0 if self.method == 'realtime' else mean, np.float32)

    def read_shown(self):
        if 'smooth' not in self.request or self.done < 2:
            return None
        return 0.5 * (self.request['smooth'] + self.read('Combined'))

    def cancel(self):
        self.stopped = True

    def finish(self):
        """Nothing failed."""

    def status(self):
        return 'compiling'

    def stats(self):
        return {'warnings': ['A warning.']}


class SlowEngine:
    """Notes its jobs."""

    def __init__(self):
        self.jobs = []

    def render(self, request):
        self.jobs.append(SlowJob(request))
        return self.jobs[-1]


@pytest.fixture
def engine():
    return SlowEngine()


def picture(first=0, last=8):
    return Refinement({'samples': (first, last)}, 'key')


class TestRefinement:
    def test_grows_and_ends(self, engine):
        found = picture()
        found.start(engine)
        assert found.status() == 'Compiling' and not found.has_news()
        engine.jobs[0].done = 3
        assert found.has_news()
        found.advance()
        assert found.samples == 3 and found.pixels[0, 0, 0] == 1.0 and not found.has_news()
        engine.jobs[0].done = 8
        found.advance()
        assert found.is_complete() and not found.is_running() and found.warnings == ('A warning.',)

    def test_goes_on_where_it_was_interrupted(self, engine):
        found = picture(last=10)
        for done in (3, 2):
            found.start(engine)
            engine.jobs[-1].done = done
            found.interrupt()
        found.start(engine)
        assert (engine.jobs[2].first, engine.jobs[2].last) == (5, 10)
        engine.jobs[2].done = 5
        found.advance()
        # The mean of samples 0 to 9, each counted once.
        assert found.is_complete() and found.pixels == pytest.approx(4.5)

    def test_a_job_that_ends_between_two_questions_is_fetched_before_the_next(self, engine):
        found = picture()
        found.start(engine)
        engine.jobs[0].done = 6
        found.advance()
        engine.jobs[0].done = 8
        # It gives its turn to other views, but has no samples to ask another job for.
        assert not found.is_running() and not found.is_complete() and not found.is_fetched() and found.has_news()
        found.advance()
        assert found.is_complete() and found.is_fetched() and found.samples == 8

    def test_shows_a_first_look_that_is_no_sample(self, engine):
        found = picture()
        found.start(engine)
        engine.jobs[0].looked = True
        assert found.has_news()
        found.advance()
        assert found.samples == 0 and found.pixels[0, 0, 0] == -1.0 and not found.has_news()
        engine.jobs[0].done = 3
        assert not found.first_seconds and found.has_news()
        found.advance()
        assert found.pixels[0, 0, 0] == 1.0 and found.first_seconds == 0.25

    def test_interrupted_before_the_first_sample(self, engine):
        found = picture()
        found.start(engine)
        found.interrupt()
        assert found.samples == 0 and found.pixels is None and not found.is_running()

    def test_cancelled_by_a_final_render(self, engine):
        found = picture()
        found.start(engine)
        engine.jobs[0].done = 2
        found.cancel()
        found.advance()
        assert found.samples == 2 and not found.is_running() and not found.is_complete()


class TestChangeover:
    """Real-time first, then paths."""

    @pytest.fixture
    def found(self, monkeypatch):
        monkeypatch.setattr(changeover, 'REST', 0.0)
        return changeover.picture({'samples': (0, 40), 'method': 'primitive', 'settings': {}}, 'key')

    @staticmethod
    def go(found, job, done):
        job.done = done
        assert found.has_news()
        found.advance()

    def test_methods_and_samples(self, engine, found):
        found.start(engine)
        assert not found.samples and found.status() == 'Compiling'
        self.go(found, engine.jobs[0], changeover.QUICK_SAMPLES)
        assert not found.is_running() and not found.is_complete() and found.is_ready()
        found.start(engine)
        assert found.is_unread() and found.status() == 'Paths: compiling'
        self.go(found, engine.jobs[1], 40)
        assert found.is_complete() and found.status() == 'Paths: 40 samples'
        assert [(job.method, job.first, job.last) for job in engine.jobs] == [
            ('realtime', 0, changeover.QUICK_SAMPLES), ('primitive', 0, 40)]
        assert found.warnings == ('A warning.',)

    def test_paths_take_over_the_picture_of_real_time(self, engine, found):
        assert found.shown is None
        found.start(engine)
        self.go(found, engine.jobs[0], changeover.QUICK_SAMPLES)
        quick = found.shown
        found.start(engine)
        assert (engine.jobs[1].request['smooth'] == quick).all()
        # One sample does not tell its noise.
        self.go(found, engine.jobs[1], 1)
        assert found.shown is quick
        self.go(found, engine.jobs[1], 3)
        assert found.shown == pytest.approx(0.5 * (quick + 1.0))

    def test_interrupted_and_going_on(self, engine, found):
        found.start(engine)
        engine.jobs[0].done = 2
        found.interrupt()
        assert found.samples == 2 and found.shown is not None
        found.start(engine)
        self.go(found, engine.jobs[1], changeover.QUICK_SAMPLES - 2)
        found.start(engine)
        assert 'before' not in engine.jobs[2].request
        engine.jobs[2].done = 30
        found.interrupt()
        shown = found.shown
        found.start(engine)
        request = engine.jobs[3].request
        assert request['before_samples'] == 30 and request['before'] == pytest.approx(14.5)
        self.go(found, engine.jobs[3], 1)
        assert found.shown is shown
        self.go(found, engine.jobs[3], 10)
        assert found.is_complete() and found.shown is not shown

    def test_paths_wait_until_the_view_rests(self, engine):
        found = changeover.picture({'samples': (0, 4), 'method': 'primitive', 'settings': {}}, 'key')
        assert found.is_ready()
        found.start(engine)
        self.go(found, engine.jobs[0], changeover.QUICK_SAMPLES)
        assert not found.is_ready() and found.samples

    @pytest.mark.parametrize('method, settings', [('realtime', {}), ('primitive', {'debug_picture': 'steps'})])
    def test_what_has_one_stage(self, method, settings):
        request = {'samples': (0, 4), 'method': method, 'settings': settings}
        assert isinstance(changeover.picture(request, 'key'), Refinement)


def unwanted():
    """Of a turn that must not begin."""
    raise AssertionError


class TestTurns:
    def start(self, turns, engine, found):
        assert turns.take(found, lambda: found.start(engine))

    def test_a_view_with_nothing_to_show_goes_first(self, engine):
        turns, smooth, new = Turns(), picture(), picture()
        self.start(turns, engine, smooth)
        # The first sample is never taken away.
        assert not turns.take(new, unwanted)
        engine.jobs[0].done = 1
        smooth.advance()
        self.start(turns, engine, new)
        assert engine.jobs[0].stopped and not smooth.is_running() and smooth.samples == 1

    def test_views_that_refine_wait_for_each_other(self, engine):
        turns, one, other = Turns(), picture(), picture()
        self.start(turns, engine, one)
        engine.jobs[0].done = 1
        one.advance()
        self.start(turns, engine, other)
        engine.jobs[1].done = 1
        other.advance()
        assert not turns.is_free(one) and not turns.take(one, unwanted)
        engine.jobs[1].done = 8
        assert turns.is_free(one)
        self.start(turns, engine, one)
        assert engine.jobs[2].first == 1

    def test_a_scene_that_was_written_for_a_job_is_kept_until_it_has_read_it(self, engine):
        turns, one, other = Turns(), picture(), picture()

        def write_and_start():
            # As a view does that finds another view's version of the scene.
            turns.interrupt_unread()
            one.start(engine)

        assert turns.take(one, write_and_start)
        # Nobody else writes his own before, and if he must, the job is done again.
        assert not turns.take(other, unwanted)
        turns.interrupt_unread()
        assert engine.jobs[0].stopped

    def test_a_scene_that_changes_before_a_job_has_read_it(self, engine):
        turns, one = Turns(), picture()
        self.start(turns, engine, one)
        turns.interrupt_unread()
        assert engine.jobs[0].stopped
        self.start(turns, engine, one)
        engine.jobs[1].done = 1
        one.advance()
        turns.interrupt_unread()
        assert not engine.jobs[1].stopped
        # A picture that goes on has samples, but its new job has not read the scene.
        one.interrupt()
        self.start(turns, engine, one)
        turns.interrupt_unread()
        assert engine.jobs[2].stopped and one.samples == 1

    def test_all_stop_for_a_final_render(self, engine):
        turns, one = Turns(), picture()
        self.start(turns, engine, one)
        turns.cancel_all()
        assert engine.jobs[0].stopped


class TestState:
    """What tells a 3D View whether its picture still shows the scene."""

    def test_equal_scenes_have_equal_states(self, scene, recorder):
        sync, other = Sync(recorder), Sync(Recorder())
        thing = add_object(quad(materials=1))
        sync.full(), other.full()
        before = sync.mirror.state()
        assert before == other.mirror.state()
        thing.location.x = 1.0
        bpy.context.view_layer.update()
        sync.full()
        moved = sync.mirror.state()
        assert moved != before
        thing.location.x = 0.0
        bpy.context.view_layer.update()
        sync.full()
        assert sync.mirror.state() == before

    def test_hiding_and_showing_again(self, scene, recorder):
        sync = Sync(recorder)
        add_object(quad('Other'), 'Other')
        thing = add_object(quad(materials=1))
        sync.full()
        before = sync.mirror.state()
        for hidden in (True, False):
            thing.hide_viewport = hidden
            bpy.context.view_layer.update()
            sync.full()
            assert (sync.mirror.state() == before) != hidden

    def test_lamps_materials_and_the_world_count(self, scene, recorder):
        sync = Sync(recorder)
        light = bpy.data.lights.new('Lamp', 'POINT')
        add_object(light, 'Lamp')
        material = bpy.data.materials.new('Material')
        mesh = quad()
        mesh.materials.append(material)
        add_object(mesh)
        world = scene.world = bpy.data.worlds.new('World')
        material.use_nodes = world.use_nodes = True
        color = {node.type: next(i for i in node.inputs if i.type == 'RGBA')
                 for tree in (material.node_tree, world.node_tree) for node in tree.nodes
                 if node.type in ('BSDF_PRINCIPLED', 'BACKGROUND')}
        states = set()
        for change in (lambda: None, lambda: setattr(light, 'energy', 5.0),
                       lambda: setattr(color['BSDF_PRINCIPLED'], 'default_value', (1, 0, 0, 1)),
                       lambda: setattr(color['BACKGROUND'], 'default_value', (0, 1, 0, 1))):
            change()
            bpy.context.view_layer.update()
            sync.full()
            states.add(sync.mirror.state())
        assert len(states) == 4
