// One image as a texture with all its levels, in the type and with the channels that it has.
#pragma once

#include "gl/handles.h"
#include "scene/image.h"

#include <string>

namespace panoptes::gpu_scene {

struct GpuImage {
  gl::Texture texture;
  bool srgb = false;      // sampling gives sRGB codes
  bool bordered = false;  // transparent beyond its edges where the sampler wants a border
  int64_t serial = 0;     // scene::Image::serial
  std::string warning;    // empty when it is shown as it is
};

// An image of more than `max_size` texels a side is shown by a coarser level, with a warning.
// `bordered`: some sampler clips it, so grey needs an alpha of its own, which is 0 outside.
GpuImage upload_image(const scene::Image& image, int max_size, bool bordered);

}  // namespace panoptes::gpu_scene
