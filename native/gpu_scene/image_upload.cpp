#include "gpu_scene/gpu_scene.h"

#include "base/error.h"

#include <algorithm>
#include <bit>

namespace panoptes::gpu_scene {

namespace {

bool opaque(const scene::Image& image) {
  for (size_t i = 3; i < image.bytes.size(); i += 4)
    if (image.bytes[i] != 255) return false;
  return true;
}

}  // namespace

GpuImage upload_image(const scene::Image& image, int max_size) {
  if (std::max(image.width, image.height) > max_size)
    fail("image '{}' is {}x{} and this graphics driver takes at most {} texels a side: scale it down",
         image.name, image.width, image.height, max_size);
  // Levels of sRGB images must be averages of light: with an sRGB format the driver decodes while
  // it averages. The samplers then skip the decoding, because Cycles filters codes. Where codes are
  // multiplied by alpha, only an average of codes can be divided by the average of alpha again.
  const bool averages_light = image.srgb && !image.is_float() && opaque(image) &&
                              epoxy_has_gl_extension("GL_EXT_texture_sRGB_decode");
  const GLenum format = image.is_float()   ? GLenum(GL_RGBA32F)
                        : averages_light ? GLenum(GL_SRGB8_ALPHA8)
                                           : GLenum(GL_RGBA8);
  const int levels = int(std::bit_width(unsigned(std::max(image.width, image.height))));
  GpuImage result;
  result.srgb = image.srgb;
  result.texture =
      gl::Texture({GL_TEXTURE_2D, format, image.width, image.height, 1, levels});
  if (image.is_float())
    result.texture.write(GL_RGBA, GL_FLOAT, int64_t(image.floats.size()) * 4, image.floats.data());
  else
    result.texture.write(GL_RGBA, GL_UNSIGNED_BYTE, int64_t(image.bytes.size()),
                         image.bytes.data());
  glGenerateTextureMipmap(result.texture.id());
  return result;
}

}  // namespace panoptes::gpu_scene
