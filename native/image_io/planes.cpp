#include "image_io/planes.h"

#include "base/error.h"

#include <algorithm>

namespace panoptes::image_io {

namespace {

constexpr int kRows = 32;  // as many as OpenEXR decodes at once with its larger blocks

void read_rows(OIIO::ImageInput& input, const std::string& path, int y, int end, float* values) {
  const OIIO::ImageSpec& spec = input.spec();
  if (!input.read_scanlines(input.current_subimage(), 0, spec.y + y, spec.y + end, 0, 0,
                            spec.nchannels, OIIO::TypeDesc::FLOAT, values))
    fail("'{}' cannot be read ({}): render it again", path, input.geterror());
}

void write_rows(OIIO::ImageOutput& output, const std::string& path, int y, int end,
                const float* values) {
  const OIIO::ImageSpec& spec = output.spec();
  if (!output.write_scanlines(spec.y + y, spec.y + end, 0, OIIO::TypeDesc::FLOAT, values))
    fail("'{}' cannot be written ({}): check the folder and the free space", path,
         output.geterror());
}

}  // namespace

void write_planes(OIIO::ImageOutput& output, const std::string& path,
                  const std::vector<Plane>& planes) {
  const OIIO::ImageSpec& spec = output.spec();
  const size_t width = size_t(spec.width), count = planes.size();
  std::vector<float> rows(width * kRows * count);
  for (int y = 0; y < spec.height; y += kRows) {
    const int end = std::min(y + kRows, spec.height);
    for (int row = y; row < end; ++row)
      for (size_t c = 0; c < count; ++c) {
        const Plane& plane = planes[c];
        const float* in = plane.values + size_t(spec.height - 1 - row) * width * plane.stride;
        float* out = rows.data() + size_t(row - y) * width * count + c;
        for (size_t x = 0; x < width; ++x) out[x * count] = in[x * plane.stride];
      }
    write_rows(output, path, y, end, rows.data());
  }
}

void read_planes(OIIO::ImageInput& input, const std::string& path,
                 const std::vector<Target>& targets) {
  const OIIO::ImageSpec& spec = input.spec();
  const size_t width = size_t(spec.width), stored = size_t(spec.nchannels);
  std::vector<float> rows(width * kRows * stored);
  for (int y = 0; y < spec.height; y += kRows) {
    const int end = std::min(y + kRows, spec.height);
    read_rows(input, path, y, end, rows.data());
    for (int row = y; row < end; ++row)
      for (const Target& target : targets) {
        const float* in = rows.data() + size_t(row - y) * width * stored + size_t(target.channel);
        float* out = target.values + size_t(spec.height - 1 - row) * width * target.stride;
        for (size_t x = 0; x < width; ++x) out[x * target.stride] = in[x * stored];
      }
  }
}

void copy_picture(OIIO::ImageInput& input, const std::string& source, OIIO::ImageOutput& output,
                  const std::string& target) {
  const OIIO::ImageSpec& spec = input.spec();
  std::vector<float> rows(size_t(spec.width) * kRows * size_t(spec.nchannels));
  for (int y = 0; y < spec.height; y += kRows) {
    const int end = std::min(y + kRows, spec.height);
    read_rows(input, source, y, end, rows.data());
    write_rows(output, target, y, end, rows.data());
  }
}

}  // namespace panoptes::image_io
