# SPDX-License-Identifier: GPL-3.0-or-later
"""Where cameras stand and what they see, as matrices, and the frame of a render."""

import numpy as np


def inverted(matrix):
    """Return the inverse of a matrix in double precision, or the matrix where there is none.

    Blender's own inverse is in single precision: a camera at 1000 km would be off by centimetres.
    """
    matrix = np.array(matrix, np.float64)
    try:
        return np.linalg.inv(matrix)
    except np.linalg.LinAlgError:
        return matrix


def matrices(depsgraph, camera, width, height):
    """Return (world to camera, camera to clip space) of an evaluated camera for a frame in pixels.

    Both are 4x4; what stands nowhere has numbers in them that are not finite.
    """
    render = depsgraph.scene.render
    projection = np.array(camera.calc_matrix_camera(
        depsgraph, x=max(width, 1), y=max(height, 1), scale_x=render.pixel_aspect_x,
        scale_y=render.pixel_aspect_y), np.float64)
    # A camera's scale never changes the picture.
    return inverted(camera.matrix_world.normalized()), projection


def frame(render):
    """Return (width, height) of a scene's whole frame in pixels."""
    return (render.resolution_x * render.resolution_percentage // 100,
            render.resolution_y * render.resolution_percentage // 100)


def is_panoramic(camera):
    """Tell whether an object is a camera whose view no matrix can describe."""
    return camera.type == 'CAMERA' and camera.data.type == 'PANO'
