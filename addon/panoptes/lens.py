# SPDX-License-Identifier: GPL-3.0-or-later
"""The aperture of a camera with depth of field, by Cycles' conventions."""

import math

# Cycles' least f-number and focus distance: without them there would be divisions by 0.
_LEAST_FSTOP = _LEAST_DISTANCE = 1e-5


def is_used(camera):
    """Tell whether an object is a camera with depth of field."""
    return camera.type == 'CAMERA' and camera.data.dof.use_dof


def _focus_distance(camera):
    """Return the distance of what is sharp, along the camera's axis, in metres."""
    dof = camera.data.dof
    if dof.focus_object is None:
        return dof.focus_distance
    place = dof.focus_object.matrix_world
    if dof.focus_subtarget and dof.focus_object.pose is not None:
        bone = dof.focus_object.pose.bones.get(dof.focus_subtarget)
        if bone is not None:
            place = place @ bone.matrix
    there = camera.matrix_world.normalized()
    return abs((there.translation - place.translation).dot(there.col[2].xyz))


def of(camera, warn):
    """Return the request's `lens` of an evaluated camera; {} where everything is sharp.

    Lengths are in metres and the rotation in radians. The radius of a perspective lens is half its
    focal length over the f-number; an orthographic view has no focal length and takes 1 m.
    """
    if not is_used(camera):
        return {}
    data, dof = camera.data, camera.data.dof
    distance = _focus_distance(camera)
    if not math.isfinite(distance):
        warn(f"What camera '{camera.name}' focuses on has no place; everything is sharp instead. Clear the "
             "transform of its focus object or choose another.")
        return {}
    focal_length = 1.0 if data.type == 'ORTHO' else data.lens * 1e-3
    return {
        'radius': focal_length / (2.0 * max(dof.aperture_fstop, _LEAST_FSTOP)),
        'focus_distance': max(distance, _LEAST_DISTANCE),
        'blades': dof.aperture_blades,
        'rotation': dof.aperture_rotation,
        'ratio': dof.aperture_ratio,
    }
