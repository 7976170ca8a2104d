# SPDX-License-Identifier: GPL-3.0-or-later
"""The list of instances of a dependency graph: which geometry stands where, with which materials."""

from typing import NamedTuple

import numpy as np

from .. import compat
from . import lights


# Objects that would be seen, by what to call them. Grease Pencil drawings are drawn over the picture by
# Blender itself.
_LEFT_OUT = {
    'VOLUME': 'a volume',
    'CURVES': 'hair',
    'POINTCLOUD': 'a point cloud',
}


class Geometry(NamedTuple):
    """One distinct mesh as met in a pass."""

    key: tuple       # stable name across passes
    owners: tuple    # keys of the data-blocks whose change means that it changed
    pointer: int     # address of the evaluated data; tells re-evaluations apart
    slots: int       # number of material slots, at least one


class InstanceList(NamedTuple):
    """Everything that one walk over the instances found."""

    geometry: list   # Geometry, without repetition
    mesh_index: np.ndarray     # int64[N], into `geometry`
    matrices: np.ndarray       # float32[N, 4, 4], object to world, row-major
    slot_sets: list            # tuples of material addresses (0 = none), without repetition
    slot_index: np.ndarray     # int32[N], into `slot_sets`
    lights: list


def read_matrices(depsgraph, count):
    """Return all instances' matrices, float32[count, 4, 4], row-major."""
    matrices = np.empty((count, 16), np.float32)
    depsgraph.object_instances.foreach_get('matrix_world', matrices.reshape(-1))
    return np.ascontiguousarray(matrices.reshape(-1, 4, 4).transpose(0, 2, 1))


def _slots(thing, real, own_data):
    """Return the evaluated materials of an instance's slots, in order; at least one.

    `real` is the evaluated object behind it. Geometry that nodes generate brings its own materials;
    an object's slots count for its own data only.
    """
    slots = real.material_slots if own_data else ()
    found = tuple(slot.material for slot in slots)
    return found or tuple(getattr(thing.data, 'materials', ())) or (None,)


class Walk:
    """One walk over a dependency graph's instances.

    `meet(slots)` is called for each distinct tuple of materials, before the geometry that brings
    them. `visit(instance_object, geometry)` is called for each distinct geometry while its object is
    alive, and returns whether there is anything to draw. `space` is the 3D View for local view, or
    None. `warn` takes sentences.
    """

    def __init__(self, depsgraph, meet, visit, warn, space=None):
        self._depsgraph = depsgraph
        self._meet_slots = meet
        self._visit = visit
        self._warn = warn
        self._space = space
        self._by_pointer = {}
        self._ordinals = {}
        self._geometry = []
        self._slot_sets = {}
        self._visible = {}

    def run(self):
        """Return the `InstanceList`."""
        instances = self._depsgraph.object_instances
        matrices = read_matrices(self._depsgraph, len(instances))
        finite = np.isfinite(matrices).all(axis=(1, 2))
        all_finite = bool(finite.all())
        rows, mesh_index, slot_index, found_lights = [], [], [], []

        # `instance` and `instance.object` are recycled by Blender: nothing of them may be kept.
        for row, instance in enumerate(instances):
            thing = instance.object
            kind = thing.type
            is_light = kind == 'LIGHT'
            # Curves, text and metaballs come a second time as the mesh that Blender made of them.
            if not is_light and kind != 'MESH':
                if kind in _LEFT_OUT:
                    self._warn(f"Object '{thing.name}' is {_LEFT_OUT[kind]}, which is not supported "
                               'yet; it is left out.')
                continue
            if not instance.show_self or not self._is_visible(instance):
                continue
            if not all_finite and not finite[row]:
                self._warn(f"Object '{thing.name}' has a place or scale that is not a number; it is "
                           'left out. Clear its transform.')
                continue
            if is_light:
                found_lights.append(lights.describe(thing.data, matrices[row], self._warn))
                continue
            place = self._place(instance, thing)
            if place is not None:
                rows.append(row)
                mesh_index.append(place[0])
                slot_index.append(place[1])

        return InstanceList(self._geometry, np.array(mesh_index, np.int64),
                            np.ascontiguousarray(matrices[rows]), list(self._slot_sets),
                            np.array(slot_index, np.int32), found_lights)

    def _is_visible(self, instance):
        """Apply a 3D View's local view and its hidden collections."""
        if self._space is None:
            return True
        shown = (instance.parent or instance.object) if instance.is_instance else instance.object
        key = shown.as_pointer()
        if key not in self._visible:
            # Blender notes local views with evaluated objects, local collections with the original.
            asked = shown if self._space.local_view is not None else shown.original
            self._visible[key] = asked.visible_in_viewport_get(self._space)
        return self._visible[key]

    def _place(self, instance, thing):
        """Return (index of the geometry, index of the slot set) of an instance, or None."""
        data = thing.data
        pointer = data.as_pointer()
        # The same data under objects with other slots is the same geometry with other materials.
        known = self._by_pointer.get(pointer)
        if known is None:
            known = self._by_pointer[pointer] = self._meet(instance, thing, data, pointer)
        index, own_data = known
        if index is None:
            return None
        return index, self._slot_set(_slots(thing, self._real(thing), own_data))

    def _slot_set(self, slots):
        """Return the index of a tuple of materials among those met so far."""
        key = tuple(m.as_pointer() if m is not None else 0 for m in slots)
        found = self._slot_sets.get(key)
        if found is None:
            found = self._slot_sets[key] = len(self._slot_sets)
            self._meet_slots(slots)
        return found

    def _real(self, thing):
        """Return the evaluated object that an instance shows a part of."""
        return thing.original.evaluated_get(self._depsgraph)

    def _meet(self, instance, thing, data, pointer):
        """Take note of a geometry that is met for the first time in this pass."""
        real = self._real(thing)
        owner = compat.stable_key(real)
        # Nodes can hang several generated meshes on one object; they come in a stable order.
        ordinal = self._ordinals[owner] = self._ordinals.get(owner, -1) + 1
        # A curve's own geometry is the mesh made of it, which comes first.
        own_data = real.data is not None and (
            real.data.as_pointer() == pointer or (real.type != 'MESH' and ordinal == 0))
        maker = instance.parent if instance.is_instance and instance.parent else real
        owners = {owner, compat.stable_key(data), compat.stable_key(maker)}
        if real.data is not None:
            owners.add(compat.stable_key(real.data))
        slots = _slots(thing, real, own_data)
        self._slot_set(slots)
        geometry = Geometry((owner, ordinal), tuple(owners), pointer, len(slots))
        if not self._visit(thing, geometry):
            return None, own_data
        self._geometry.append(geometry)
        return len(self._geometry) - 1, own_data
