#include "image_io/image_io.h"

#include "base/error.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>

namespace panoptes::image_io {

namespace {

// Spreads 1 to n stored channels over four; grey becomes RGB, missing alpha becomes opaque.
template <class T>
std::vector<T> to_rgba(const std::vector<T>& in, int channels, T opaque) {
  const size_t pixels = in.size() / size_t(channels);
  std::vector<T> out(pixels * 4);
  for (size_t i = 0; i < pixels; ++i) {
    const T* p = &in[i * size_t(channels)];
    T* q = &out[i * 4];
    const bool grey = channels < 3;
    q[0] = p[0];
    q[1] = grey ? p[0] : p[1];
    q[2] = grey ? p[0] : p[2];
    q[3] = channels == 2 ? p[1] : channels > 3 ? p[3] : opaque;
  }
  return out;
}

template <class T>
std::vector<T> read_pixels(OIIO::ImageInput& input, const OIIO::ImageSpec& spec,
                           const std::string& name, T opaque) {
  std::vector<T> stored(size_t(spec.width) * size_t(spec.height) * size_t(spec.nchannels));
  // The file's first row is the top one; a negative stride writes it last.
  const OIIO::stride_t row = OIIO::stride_t(spec.width) * spec.nchannels * int(sizeof(T));
  T* last = stored.data() + size_t(spec.height - 1) * size_t(spec.width) * size_t(spec.nchannels);
  if (!input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeDescFromC<T>::value(), last,
                        OIIO::AutoStride, -row))
    fail("image '{}' cannot be read ({}): replace or re-save the file", name, input.geterror());
  return to_rgba(stored, spec.nchannels, opaque);
}

scene::Image read(std::unique_ptr<OIIO::ImageInput> input, const std::string& name, bool srgb,
                  scene::AlphaMode alpha) {
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1)
    fail("image '{}' has no pixels: replace the file", name);
  if (spec.format.basetype == OIIO::TypeDesc::UINT8)
    return scene::make_image(name, spec.width, spec.height,
                             std::span<const uint8_t>(
                                 read_pixels<uint8_t>(*input, spec, name, uint8_t(255))),
                             srgb, alpha);
  const std::vector<float> pixels = read_pixels<float>(*input, spec, name, 1.0f);
  return scene::make_image(name, spec.width, spec.height, std::span<const float>(pixels), srgb,
                           alpha);
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
  return read(std::move(input), name, srgb, alpha);
}

scene::Image load_memory(const std::string& name, std::span<const char> data, bool srgb,
                         scene::AlphaMode alpha) {
  // Every reader looks for its own mark at the data's start; Targa has none and comes last.
  for (const char* format : {"png", "jpeg", "openexr", "hdr", "tiff", "webp", "bmp", "targa"}) {
    auto input = OIIO::ImageInput::create(format);
    if (!input || !input->supports("ioproxy")) continue;
    OIIO::Filesystem::IOMemReader reader(const_cast<char*>(data.data()), data.size());
    OIIO::ImageSpec spec;
    input->set_ioproxy(&reader);
    if (input->open(name, spec, keep_alpha_as_stored()))
      return read(std::move(input), name, srgb, alpha);
  }
  OIIO::geterror();  // what the refusals left behind would show up with the next image
  fail("packed image '{}' is in a format that cannot be decoded: unpack it and re-save it as PNG",
       name);
}

}  // namespace panoptes::image_io
