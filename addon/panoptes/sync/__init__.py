# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's scene -> the native scene, in full or by change.

A `SceneSync` belongs to one use of the engine (final renders, or the viewports of a view layer). Each
call of `sync` walks the instances, which is cheap, and extracts only geometry, materials and images
that may have changed; the `Mirror` then sends only what differs.
"""

import time
from typing import NamedTuple

import numpy as np

from .. import nodes
from . import meshes
from .changes import Changes
from .instances import Walk
from .materials import MaterialPass
from .mirror import Mirror

__all__ = ['Mirror', 'SceneSync', 'SyncReport']


class SyncReport:
    """What a pass did: `milliseconds` by phase, `warnings`, and counts of what was extracted."""

    def __init__(self):
        self.milliseconds = {}
        self.warnings = []
        self.meshes_extracted = 0
        self.materials_compiled = 0
        self._started = time.perf_counter()
        self._last = self._started

    def phase(self, name):
        """End a phase: the time since the last one ended is its own."""
        now = time.perf_counter()
        self.milliseconds[name] = self.milliseconds.get(name, 0.0) + (now - self._last) * 1e3
        self._last = now

    @property
    def total_ms(self):
        """Milliseconds of all phases together."""
        return sum(self.milliseconds.values())

    def warn(self, sentence):
        """Add a sentence for the artist once."""
        if sentence not in self.warnings:
            self.warnings.append(sentence)


class _Held(NamedTuple):
    """What is known of a geometry since it was last extracted."""

    pointer: int          # address of the evaluated data that it was read from
    empty: bool           # nothing to draw
    warnings: tuple       # sentences that hold as long as the geometry does
    available: frozenset  # names of attributes that a material could read
    delivered: frozenset  # those that were sent


class SceneSync:
    """Keeps the native scene equal to what one dependency graph shows."""

    def __init__(self):
        self._held = {}
        self._shaders = {}
        self._world = None

    def sync(self, mirror, depsgraph, space=None, incremental=True):
        """Bring `mirror` up to date; return a `SyncReport`.

        `space` is the 3D View whose local view counts, or None. `incremental` says that
        `depsgraph.updates` tells everything since this object's last call; without it, or when
        somebody else has written to the mirror since, everything is read (and still only what
        differs is sent). Raises what the native module raises.
        """
        report = SyncReport()
        everything = not incremental or mirror.owner is not self
        changes = Changes(everything=True) if everything else Changes.read(depsgraph)
        # Until the pass is through, the native scene is nobody's.
        mirror.owner = None

        materials = MaterialPass(mirror, self._shaders, changes, report)
        try:
            found = self._sync_geometry(mirror, depsgraph, space, changes, materials, report)
            report.phase('geometry')
            world_textures = self._compile_world(depsgraph.scene.world, changes, materials)
            materials.images.finish()
            report.phase('images')
        finally:
            materials.images.finish()
        material_ids = materials.send()
        mirror.put_world(self._world, world_textures)
        for sentence in self._world.warnings:
            report.warn(sentence)
        self._shaders = materials.shaders
        report.phase('materials')

        self._sync_instances(mirror, found, material_ids)
        mirror.put_lights(found.lights)
        mesh_ids = {mirror.id_of('mesh', g.key) for g in found.geometry}
        mirror.keep_only(mesh_ids, {i for i in material_ids.values() if i}, materials.images.used)
        report.phase('instances')
        mirror.owner = self
        return report

    # Geometry

    def _sync_geometry(self, mirror, depsgraph, space, changes, materials, report):
        """Walk over the instances and extract what has changed; return the `InstanceList`."""
        met, wanted = {}, {}

        def visit(thing, geometry, slots):
            key = geometry.key
            held = met.get(key) or self._held.get(key)
            current = held is not None and held.pointer == geometry.pointer and (
                key in met or not changes.touches_geometry(geometry.owners))
            if key in wanted:
                names = wanted[key]
            else:
                # Slots that are met later may want more: most likely what they wanted last time.
                names = materials.attributes_of(slots).union(held.delivered if held else ())
            if not current or held.delivered != names & held.available:
                held = self._extract(mirror, thing, geometry, names, report,
                                     depsgraph.mode == 'RENDER')
            met[key] = held
            return not held.empty

        def walk():
            return Walk(depsgraph, materials.meet, visit, report.warn, space).run()

        found = walk()
        # Now it is known which attributes are read; where that was not foreseen, read again.
        wanted = self._wanted_attributes(found, materials)
        if any(names & met[key].available != met[key].delivered for key, names in wanted.items()):
            found = walk()
        self._held = met
        for held in met.values():
            for sentence in held.warnings:
                report.warn(sentence)
        return found

    @staticmethod
    def _wanted_attributes(found, materials):
        """Return the names of attributes that each geometry's materials read, by key."""
        names = [materials.attributes_of_addresses(slots) for slots in found.slot_sets]
        return {geometry.key: frozenset().union(*(names[index] for index in indices))
                for geometry, indices in zip(found.geometry, found.slot_sets_by_geometry())}

    @staticmethod
    def _extract(mirror, thing, geometry, wanted, report, final):
        warnings = []
        extracted = meshes.extract(thing, geometry.slots, wanted, warnings.append, final)
        report.meshes_extracted += 1
        if extracted.mesh is not None:
            mirror.put_mesh(mirror.id_of('mesh', geometry.key), extracted.mesh)
        return _Held(geometry.pointer, extracted.mesh is None, tuple(warnings),
                     extracted.available, extracted.delivered)

    # World

    def _compile_world(self, world, changes, materials):
        """Compile the world if it may have changed; return its textures with image ids."""
        if self._world is None or self._world.depends_on_objects or changes.world:
            self._world = nodes.compile_world(world)
        return materials.textures(self._world, f"World '{world.name if world else ''}'")

    # Instances

    @staticmethod
    def _sync_instances(mirror, found, material_ids):
        mesh_ids = np.array([mirror.id_of('mesh', g.key) for g in found.geometry] or [0], np.int64)
        table, starts = [], []
        for pointers in found.slot_sets:
            starts.append(len(table))
            table.extend(material_ids[pointer] for pointer in pointers)
        offsets = np.array(starts or [0], np.int32)
        mirror.put_instances(mesh_ids[found.mesh_index], found.matrices,
                             offsets[found.slot_index], np.array(table or [0], np.int64),
                             found.visibility, found.indirect_scales)
