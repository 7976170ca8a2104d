// Channels of float pictures between memory and OpenImageIO, some rows at a time. In memory the rows
// run bottom to top, in files from the top.
#pragma once

#include <OpenImageIO/imageio.h>

#include <string>
#include <vector>

namespace panoptes::image_io {

// One channel: the value of pixel i is values[i * stride].
struct Plane {
  std::string name;
  const float* values = nullptr;
  size_t stride = 1;
};

// Writes the part that `output` is at, in the order of its spec's channels. All of these throw Error
// naming the file that cannot be read or written.
void write_planes(OIIO::ImageOutput& output, const std::string& path,
                  const std::vector<Plane>& planes);

// Where a channel of a file goes: the value of pixel i to values[i * stride].
struct Target {
  int channel = 0;
  float* values = nullptr;
  size_t stride = 1;
};

// Reads channels of the part that `input` is at.
void read_planes(OIIO::ImageInput& input, const std::string& path,
                 const std::vector<Target>& targets);

// Copies the part that `input` is at as floats.
void copy_picture(OIIO::ImageInput& input, const std::string& source, OIIO::ImageOutput& output,
                  const std::string& target);

}  // namespace panoptes::image_io
