#include "image_io/image_io.h"

#include "base/error.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace panoptes::image_io {

namespace {

// Rows that are decoded at once: little enough to stay in the processor's cache.
constexpr int kRows = 32;

scene::PixelType type_of(const OIIO::ImageSpec& spec) {
  switch (spec.format.basetype) {
    case OIIO::TypeDesc::UINT8: return scene::PixelType::kByte;
    case OIIO::TypeDesc::UINT16: return scene::PixelType::kShort;
    case OIIO::TypeDesc::HALF: return scene::PixelType::kHalf;
    default: return scene::PixelType::kFloat;
  }
}

OIIO::TypeDesc decoded_as(scene::PixelType type) {
  switch (type) {
    case scene::PixelType::kByte: return OIIO::TypeDesc::UINT8;
    case scene::PixelType::kShort: return OIIO::TypeDesc::UINT16;
    case scene::PixelType::kHalf: return OIIO::TypeDesc::HALF;
    default: return OIIO::TypeDesc::FLOAT;
  }
}

// A header may promise pixels that the file cannot hold: memory for them is never asked for.
void check_promise(const std::string& name, const OIIO::ImageSpec& spec, uint64_t file_bytes) {
  // Whatever is smaller is cheap to try; no format packs an image of this size closer.
  constexpr uint64_t kSmall = uint64_t(1) << 28, kClosest = 4000;
  const uint64_t promised = uint64_t(spec.image_bytes());
  if (promised > kSmall && promised / kClosest > file_bytes)
    fail("image '{}' is damaged, since {} bytes cannot hold {}x{} pixels: replace the file", name,
         file_bytes, spec.width, spec.height);
}

// Spreads `stored` channels a pixel over those of the image; missing alpha becomes `opaque`.
template <class T>
void spread(const T* in, int stored, T* out, int channels, size_t pixels, T opaque) {
  if (stored == 3 && channels == 4) {  // by far the most common, and fast when the counts are known
    for (size_t i = 0; i < pixels; ++i, in += 3, out += 4) {
      out[0] = in[0];
      out[1] = in[1];
      out[2] = in[2];
      out[3] = opaque;
    }
    return;
  }
  const int copied = std::min(stored, channels);
  for (size_t i = 0; i < pixels; ++i, in += stored, out += channels) {
    for (int c = 0; c < copied; ++c) out[c] = in[c];
    if (copied < channels) out[channels - 1] = opaque;
  }
}

template <class T>
void read_pixels(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, scene::Image& image,
                 T opaque) {
  // Tiles come all at once.
  const int rows = spec.tile_width ? spec.height : std::min(kRows, spec.height);
  const OIIO::TypeDesc type = decoded_as(image.type);
  const size_t width = size_t(spec.width), stored = size_t(spec.nchannels);
  const auto block = std::make_unique_for_overwrite<T[]>(width * size_t(rows) * stored);
  for (int y = 0; y < spec.height; y += rows) {
    const int end = std::min(y + rows, spec.height);
    const bool read = spec.tile_width ? input.read_image(0, 0, 0, spec.nchannels, type, block.get())
                                      : input.read_scanlines(0, 0, spec.y + y, spec.y + end, 0, 0,
                                                             spec.nchannels, type, block.get());
    if (!read)
      fail("image '{}' cannot be read ({}): replace or re-save the file", image.name,
           input.geterror());
    // The file's first row is the top one.
    for (int row = y; row < end; ++row)
      spread(block.get() + size_t(row - y) * width * stored, int(stored),
             image.pixels<T>().data() +
                 size_t(spec.height - 1 - row) * width * size_t(image.channels),
             image.channels, width, opaque);
  }
}

// Radiance's shared exponent leaves eight bits to the largest channel, cut off below. Blender puts what
// it decodes itself, packed images, in the middle of what was cut off; OpenImageIO, by which Cycles
// reads files, does not: .4 % of a sky's light.
void add_half_steps(scene::Image& image) {
  float* end = image.pixels<float>().data() + image.pixels<float>().size();
  for (float* texel = image.pixels<float>().data(); texel < end; texel += image.channels) {
    const float largest = std::max({texel[0], texel[1], texel[2]});
    if (!(largest > 0)) continue;
    int exponent = 0;
    std::frexp(largest, &exponent);
    for (int c = 0; c < 3; ++c) texel[c] += std::ldexp(0.5f, exponent - 8);
  }
}

scene::Image read(OIIO::ImageInput& input, const std::string& name, bool srgb,
                  scene::AlphaMode alpha, uint64_t file_bytes, bool packed) {
  const OIIO::ImageSpec& spec = input.spec();
  if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1 || spec.deep)
    fail("image '{}' has no pixels of a picture: replace the file", name);
  check_promise(name, spec, file_bytes);
  const int channels = spec.nchannels > 2 ? 4 : spec.nchannels;
  scene::Image image =
      scene::new_image(name, spec.width, spec.height, type_of(spec), channels, srgb);
  switch (image.type) {
    case scene::PixelType::kByte: read_pixels<uint8_t>(input, spec, image, 255); break;
    case scene::PixelType::kShort: read_pixels<uint16_t>(input, spec, image, 65535); break;
    case scene::PixelType::kHalf: read_pixels<uint16_t>(input, spec, image, 0x3c00); break;
    case scene::PixelType::kFloat: read_pixels<float>(input, spec, image, 1.0f); break;
  }
  if (packed && input.format_name() == std::string_view("hdr") && channels == 4 &&
      image.type == scene::PixelType::kFloat)
    add_half_steps(image);
  const bool has_alpha = spec.nchannels == 2 || spec.nchannels > 3;
  // Alpha 1 leaves colours as they are, whatever is said of it.
  scene::finish_image(image, has_alpha ? alpha : scene::AlphaMode::kPremultiplied);
  return image;
}

OIIO::ImageSpec keep_alpha_as_stored() {
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  return config;
}

}  // namespace

scene::Image load_file(const std::string& name, const std::string& path, bool srgb,
                       scene::AlphaMode alpha) {
  const OIIO::ImageSpec config = keep_alpha_as_stored();
  auto input = OIIO::ImageInput::open(path, &config);
  if (!input)
    fail("image '{}' cannot be opened at '{}' ({}): find the missing file or pack it", name, path,
         OIIO::geterror());
  scene::Image image = read(*input, name, srgb, alpha, OIIO::Filesystem::file_size(path),
                            false);
  image.reload = [name, path, srgb, alpha] { return load_file(name, path, srgb, alpha); };
  return image;
}

scene::Image load_memory(const std::string& name, std::shared_ptr<const std::string> data,
                         bool srgb, scene::AlphaMode alpha) {
  // Every reader looks for its own mark at the data's start; Targa has none and comes last.
  for (const char* format : {"png", "jpeg", "openexr", "hdr", "tiff", "webp", "bmp", "targa"}) {
    auto input = OIIO::ImageInput::create(format);
    if (!input || !input->supports("ioproxy")) continue;
    OIIO::Filesystem::IOMemReader reader(const_cast<char*>(data->data()), data->size());
    OIIO::ImageSpec spec;
    input->set_ioproxy(&reader);
    if (!input->open(name, spec, keep_alpha_as_stored())) continue;
    scene::Image image = read(*input, name, srgb, alpha, data->size(), true);
    image.reload = [name, data, srgb, alpha] { return load_memory(name, data, srgb, alpha); };
    return image;
  }
  OIIO::geterror();  // what the refusals left behind would show up with the next image
  fail("packed image '{}' is in a format that cannot be decoded: unpack it and re-save it as PNG",
       name);
}

}  // namespace panoptes::image_io
