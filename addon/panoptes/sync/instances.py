# SPDX-License-Identifier: GPL-3.0-or-later
"""The list of instances of a dependency graph: which geometry stands where, with which materials.

Ten thousand instances are common, so each costs one look at which objects it belongs to: what
follows from those is found out once a pass, and the matrices come in one piece.
"""

from typing import NamedTuple

import numpy as np

from .. import compat, indirect_scale
from . import lights, visibility


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
    visibility: np.ndarray     # uint8[N], bits of `visibility`
    indirect_scales: np.ndarray  # float32[N, 2], what luminance and chrominance are multiplied by
    lights: list

    def slot_sets_by_geometry(self):
        """Return for each geometry the set of indices of the slot sets that it is shown with."""
        found = [set() for _ in self.geometry]
        for pair in np.unique(np.stack((self.mesh_index, self.slot_index)), axis=1).T:
            found[pair[0]].add(int(pair[1]))
        return found


class _Place(NamedTuple):
    """What all instances of the same objects have in common."""

    name: str
    light: object = None    # the evaluated lamp
    geometry: int = -1      # into the list of geometries
    slot_set: int = 0
    visibility: int = 0
    indirect_scale: tuple = indirect_scale.NEUTRAL


_NOTHING = _Place('')


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
    found = tuple([slot.material for slot in real.material_slots]) if own_data else ()
    return found or tuple(getattr(thing.data, 'materials', ())) or (None,)


class Walk:
    """One walk over a dependency graph's instances.

    `meet(slots)` is called for each distinct tuple of materials, before the geometry that brings
    them. `visit(instance_object, geometry, slots)` is called for each distinct geometry while its
    object is alive, and returns whether there is anything to draw. `space` is the 3D View for local
    view, or None. `warn` takes sentences.
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

    def run(self):
        """Return the `InstanceList`."""
        places, index, rows = [], {}, []
        # `instance` and `instance.object` are recycled by Blender: nothing of them may be kept. The
        # hash of a data-block is its address.
        for instance in self._depsgraph.object_instances:
            thing = instance.object
            key = (hash(thing.original), hash(thing.data), hash(instance.parent),
                   instance.show_self)
            found = index.get(key)
            if found is None:
                found = index[key] = len(places)
                places.append(self._place(instance, thing))
            rows.append(found)
        return self._collect(places, np.array(rows, np.int64))

    def _collect(self, places, rows):
        """Return the `InstanceList` of instances whose places are `places[rows]`."""
        places = places or [_NOTHING]
        matrices = read_matrices(self._depsgraph, len(rows))
        geometry = np.array([place.geometry for place in places], np.int64)[rows]
        is_light = np.array([place.light is not None for place in places], bool)[rows]
        finite = np.isfinite(matrices).all(axis=(1, 2))
        for place in np.unique(rows[~finite & (is_light | (geometry >= 0))]):
            self._warn(f"Object '{places[place].name}' has a place or scale that is not a number; "
                       'it is left out. Clear its transform.')
        drawn = finite & (geometry >= 0)
        slot_index = np.array([place.slot_set for place in places], np.int32)[rows]
        bits = np.array([place.visibility for place in places], np.uint8)[rows]
        scales = np.array([place.indirect_scale for place in places], np.float32)[rows]
        # By name, since each lamp has its own sequence of samples and Blender's order may change.
        shining = sorted(np.flatnonzero(finite & is_light), key=lambda row: places[rows[row]].name)
        found_lights = [lights.describe(places[rows[row]].light, matrices[row], self._warn)
                        for row in shining]
        return InstanceList(self._geometry, geometry[drawn], matrices[drawn],
                            list(self._slot_sets), slot_index[drawn], bits[drawn], scales[drawn],
                            found_lights)

    def _place(self, instance, thing):
        """Return the `_Place` of an instance whose objects are met for the first time."""
        kind = thing.type
        if instance.show_particles and visibility.has_hair(thing) and self._is_shown(thing):
            self._warn(f"Object '{thing.name}' has hair particles rendered as paths, which are not "
                       'supported yet; they are left out. Render them as objects, or convert them '
                       'to meshes.')
        # Curves, text and metaballs come a second time as the mesh that Blender made of them.
        if kind not in ('MESH', 'LIGHT'):
            if kind in _LEFT_OUT:
                self._warn(f"Object '{thing.name}' is {_LEFT_OUT[kind]}, which is not supported "
                           'yet; it is left out.')
            return _NOTHING
        if not instance.show_self or not self._is_shown(thing):
            return _NOTHING
        if kind == 'LIGHT':
            return _Place(thing.name, light=thing.data)
        maker = (instance.parent if instance.is_instance else None) or thing
        bits = visibility.rays(thing, maker, self._depsgraph.view_layer_eval, self._warn)
        if bits == 0:
            return _NOTHING
        found = self._shape(instance, thing, maker)
        if found is None:
            return _NOTHING
        return _Place(thing.name, geometry=found[0], slot_set=found[1], visibility=bits,
                      indirect_scale=indirect_scale.of_instance(thing, maker, self._warn))

    def _is_shown(self, thing):
        """Apply a 3D View's local view and its hidden collections.

        Only evaluated objects know about them; an instance has what its maker has.
        """
        return self._space is None or thing.visible_in_viewport_get(self._space)

    def _shape(self, instance, thing, maker):
        """Return (index of the geometry, index of the slot set) of an instance, or None."""
        data = thing.data
        pointer = data.as_pointer()
        real = thing.original.evaluated_get(self._depsgraph) if instance.is_instance else thing
        # The same data under objects with other slots is the same geometry with other materials.
        known = self._by_pointer.get(pointer)
        if known is None:
            known = self._by_pointer[pointer] = self._meet(thing, real, maker, pointer)
        index, own_data = known
        if index is None:
            return None
        return index, self._slot_set(_slots(thing, real, own_data))

    def _slot_set(self, slots):
        """Return the index of a tuple of materials among those met so far."""
        key = tuple([m.as_pointer() if m is not None else 0 for m in slots])
        found = self._slot_sets.get(key)
        if found is None:
            found = self._slot_sets[key] = len(self._slot_sets)
            self._meet_slots(slots)
        return found

    def _meet(self, thing, real, maker, pointer):
        """Take note of a geometry that is met for the first time in this pass.

        Return (its index or None when it is empty, whether it is the object's own data).
        """
        data = real.data
        own = real.original.data
        if data is not None and data.as_pointer() == pointer and not real.modifiers:
            # The mesh itself: whichever of its users comes first, it is the same.
            owner = compat.stable_key(own)
        else:
            owner = compat.stable_key(real)
        # Nodes can hang several generated meshes on one object; they come in a stable order.
        ordinal = self._ordinals[owner] = self._ordinals.get(owner, -1) + 1
        # A curve's own geometry is the mesh made of it, which comes first.
        own_data = data is not None and (
            data.as_pointer() == pointer or (real.type != 'MESH' and ordinal == 0))
        owners = {owner, compat.stable_key(real), compat.stable_key(maker)}
        if own is not None:
            owners.add(compat.stable_key(own))
        slots = _slots(thing, real, own_data)
        self._slot_set(slots)
        geometry = Geometry((owner, ordinal), tuple(owners), pointer, len(slots))
        if not self._visit(thing, geometry, slots):
            return None, own_data
        self._geometry.append(geometry)
        return len(self._geometry) - 1, own_data
