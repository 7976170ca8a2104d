#include "gpu_scene/gpu_scene.h"

#include "base/error.h"

#include <algorithm>
#include <bit>

namespace panoptes::gpu_scene {

GpuImage upload_image(const scene::Image& image, int max_size) {
  if (std::max(image.width, image.height) > max_size)
    fail("image '{}' is {}x{} and this graphics driver takes at most {} texels a side: scale it down",
         image.name, image.width, image.height, max_size);
  // Levels of sRGB images must be averages of light: with an sRGB format the driver decodes while
  // it averages. The samplers then skip the decoding, because Cycles filters codes.
  const bool decode_switch = epoxy_has_gl_extension("GL_EXT_texture_sRGB_decode");
  const bool srgb_bytes = image.srgb && !image.is_float();
  const GLenum format = image.is_float()                ? GLenum(GL_RGBA32F)
                        : srgb_bytes && decode_switch ? GLenum(GL_SRGB8_ALPHA8)
                                                        : GLenum(GL_RGBA8);
  const int levels = int(std::bit_width(unsigned(std::max(image.width, image.height))));
  GpuImage result;
  result.srgb = srgb_bytes;
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
