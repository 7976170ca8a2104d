// Makes views: of the camera with its place in a pixel, and of shadow maps.
#pragma once

#include "gpu_scene/view_shared.h"

#include <glm/glm.hpp>

namespace panoptes::gpu_scene {

// A thin lens that gathers light around the camera's place: what lies nearer or farther than the
// focus is blurred. Sharp everywhere while the radius is 0.
struct Lens {
  double radius = 0;          // m
  double focus_distance = 1;  // m, along the camera's axis
  int blades = 0;             // corners of the aperture; below 3: a disk
  double rotation = 0;        // rad, of the aperture, counterclockwise as the camera sees it
  double ratio = 1;           // of the aperture's width to its height, of an anamorphic lens
};

// A camera as Blender gives it. Throws nothing; validate with check().
struct Camera {
  glm::dmat4 world_to_camera{1.0};  // column-major
  glm::dmat4 projection{1.0};       // OpenGL's, perspective or orthographic
  int width = 0, height = 0;        // pixels
  Lens lens;                        // for rays only: what is rasterised is sharp

  // Throws Error when the size is not positive or a matrix cannot be used.
  void check(int max_size) const;
  bool perspective() const { return projection[3][3] == 0.0; }
};

// Depths of a camera's near and far plane, metres along its axis.
glm::dvec2 clip_depths(const Camera& camera);

// The camera's view of one sample. `jitter` moves the image by a part of a pixel.
shared::View camera_view(const Camera& camera, glm::dvec2 jitter);

// A box-shaped or pyramid-shaped view, as of a shadow map. x, y and axis are unit and square to each
// other; half_x and half_y are half extents (orthographic: metres, perspective: tangents), shifted by
// `shift` (same units).
struct LightView {
  glm::dvec3 origin;
  glm::dvec3 x, y, axis;
  double half_x, half_y;
  double near_depth, far_depth;  // along the axis
  bool perspective;
  glm::dvec2 shift{0, 0};
  bool operator==(const LightView&) const = default;
};
// What `light` sees in an image of so many texels.
shared::View light_view(const LightView& light, glm::ivec2 texels);

// What the camera sees in the sample that `jitter` belongs to, as camera_view() has it.
LightView as_light_view(const Camera& camera, glm::dvec2 jitter);

}  // namespace panoptes::gpu_scene
