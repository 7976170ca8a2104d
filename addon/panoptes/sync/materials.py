# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials of one synchronisation: compiled when first met, so that their images decode early."""

from .. import compat, nodes
from .images import ImageSender


class MaterialPass:
    """Compiles what may have changed and sends what differs.

    `known` are the shaders of the last pass by material key. Afterwards `shaders` are those of this
    pass, and `images` the sender of their textures.
    """

    def __init__(self, mirror, known, changes, report):
        self._mirror = mirror
        self._known = known
        self._changes = changes
        self._report = report
        self._met = {}
        self.shaders = {}
        self.images = ImageSender(mirror, changes.images, report.warn)

    def meet(self, slots):
        """Take note of the evaluated materials of an object's slots (None for empty slots)."""
        for material in slots:
            if material is not None and material.as_pointer() not in self._met:
                self._met[material.as_pointer()] = self._compile(material)

    def attributes_of(self, slots):
        """Return the names of mesh attributes that the materials of these slots read."""
        return self.attributes_of_addresses(m.as_pointer() for m in slots if m is not None)

    def attributes_of_addresses(self, addresses):
        """The same for materials by address; 0 is an empty slot."""
        keys = (self._met[address][0] for address in addresses if address)
        return frozenset().union(*(self.shaders[key].facts['attributes'] for key in keys))

    def _compile(self, material):
        """Compile a material and start on its images; return (key, name, textures)."""
        key = compat.stable_key(material)
        shader = self._known.get(key)
        if (shader is None or shader.depends_on_objects
                or self._changes.touches_material(key)):
            shader = nodes.compile_material(material)
            self._report.materials_compiled += 1
        self.shaders[key] = shader
        return key, material.name, self.textures(shader, f"Material '{material.name}'")

    def textures(self, shader, owner):
        """Return [(image id, interpolation, extension)] of a shader, sending its images."""
        return [(self.images.send(image, user, owner), interpolation, extension)
                for image, interpolation, extension, user in shader.textures]

    def send(self):
        """Bring the native materials up to date; return ids by material address (0 for none)."""
        ids = {0: 0}
        for pointer, (key, name, textures) in self._met.items():
            ids[pointer] = self._mirror.id_of('material', key)
            self._mirror.put_material(ids[pointer], name, self.shaders[key], textures)
            for sentence in self.shaders[key].warnings:
                self._report.warn(sentence)
        return ids
