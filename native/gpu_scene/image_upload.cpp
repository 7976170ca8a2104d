#include "gpu_scene/image_upload.h"

#include "base/error.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace panoptes::gpu_scene {

namespace {

// How OpenGL names what an image holds: by type, then by 1, 2 or 4 channels.
struct Format {
  GLenum stored[3];
  GLenum type;
};
constexpr Format kFormats[4] = {
    {{GL_R8, GL_RG8, GL_RGBA8}, GL_UNSIGNED_BYTE},
    {{GL_R16, GL_RG16, GL_RGBA16}, GL_UNSIGNED_SHORT},
    {{GL_R16F, GL_RG16F, GL_RGBA16F}, GL_HALF_FLOAT},
    {{GL_R32F, GL_RG32F, GL_RGBA32F}, GL_FLOAT},
};
constexpr GLenum kChannels[3] = {GL_RED, GL_RG, GL_RGBA};

// What alpha 1 is in each type.
constexpr uint32_t kOpaque[4] = {255, 65535, 0x3c00, 0x3f800000};

// Grey with an alpha of 1 to every texel.
std::vector<std::byte> with_alpha(const scene::ImageLevel& level, scene::PixelType type) {
  const size_t size = scene::bytes_of(type), texels = size_t(level.width) * size_t(level.height);
  std::vector<std::byte> both(2 * size * texels);
  for (size_t i = 0; i < texels; ++i) {
    std::memcpy(&both[2 * i * size], &level.pixels[std::ptrdiff_t(i * size)], size);
    std::memcpy(&both[(2 * i + 1) * size], &kOpaque[size_t(type)], size);
  }
  return both;
}

}  // namespace

GpuImage upload_image(const scene::Image& image, int max_size, bool bordered) {
  // The finest level that the driver takes.
  const auto fits = [&](const scene::ImageLevel& level) {
    return std::max(level.width, level.height) <= max_size;
  };
  const auto first = std::find_if(image.levels.begin(), image.levels.end(), fits);
  if (first == image.levels.end()) fail("image '{}' has no pixels: reload it", image.name);

  const bool grey = image.channels < 4;
  const bool widen = bordered && image.channels == 1;
  const size_t layout = widen || image.channels == 2 ? 1 : grey ? 0 : 2;
  const Format& format = kFormats[size_t(image.type)];
  GpuImage result;
  result.srgb = image.srgb;
  result.serial = image.serial;
  result.bordered = bordered;
  result.texture = gl::Texture({GL_TEXTURE_2D, format.stored[layout], first->width, first->height,
                                1, int(image.levels.end() - first)});
  for (auto level = first; level != image.levels.end(); ++level) {
    const int index = int(level - first);
    if (widen)
      result.texture.write(kChannels[layout], format.type, with_alpha(*level, image.type).data(),
                           index);
    else
      result.texture.write(kChannels[layout], format.type, level->pixels.get(), index);
  }
  if (grey) {
    const GLint swizzle[4] = {GL_RED, GL_RED, GL_RED, layout == 0 ? GL_ONE : GL_GREEN};
    glTextureParameteriv(result.texture.id(), GL_TEXTURE_SWIZZLE_RGBA, swizzle);
  }
  if (first != image.levels.begin())
    result.warning = fmt::format(
        "Image '{}' is {}x{} and this graphics driver takes at most {} texels a side: it is shown "
        "at {}x{}.",
        image.name, image.width, image.height, max_size, first->width, first->height);
  return result;
}

}  // namespace panoptes::gpu_scene
