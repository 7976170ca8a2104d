# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights an open scene so that only some kinds of rays find light. The file on disk stays as it is."""

import bpy

# Inputs that make nodes glow.
_GLOW = {"EMISSION": "Strength", "BSDF_PRINCIPLED": "Emission Strength"}


def by_lamps(scene):
    """Leaves the lamps alone, and without extent: only shadow rays find light."""
    _darken(scene, world=0.0)
    for lamp in bpy.data.lights:
        if lamp.type == "SUN":
            lamp.angle = 0.0
        elif lamp.type == "AREA":
            lamp.type = "POINT"
        # A lamp of another type has other properties, which only a new look at it has.
        if lamp.type in ("POINT", "SPOT"):
            bpy.data.lights[lamp.name].shadow_soft_size = 0.0


def by_world(scene):
    """Leaves a world of one colour alone: it is in no direction more than in others, so only scattered rays look for it."""
    _darken(scene, world=1.0)
    for thing in [thing for thing in scene.objects if thing.type == "LIGHT"]:
        bpy.data.objects.remove(thing)


def _darken(scene, world):
    """Puts out what glows and gives the scene a grey world of this radiance."""
    for tree in [material.node_tree for material in bpy.data.materials if material.node_tree] + list(bpy.data.node_groups):
        for node in tree.nodes:
            if node.type in _GLOW:
                strength = node.inputs[_GLOW[node.type]]
                for link in list(strength.links):
                    tree.links.remove(link)
                strength.default_value = 0.0
    scene.world = bpy.data.worlds.new("grey")
    scene.world.use_nodes = True
    background = next(node for node in scene.world.node_tree.nodes if node.type == "BACKGROUND")
    background.inputs["Color"].default_value = (world, world, world, 1.0)
