// Images from files and from memory through OpenImageIO; the only place that links it.
#pragma once

#include "scene/image.h"

#include <span>
#include <string>

namespace panoptes::image_io {

// Decodes the file at `path`. Bytes stay bytes, everything deeper becomes float. Throws Error with
// the cause when it cannot be read.
scene::Image load_file(const std::string& name, const std::string& path, bool srgb,
                       scene::AlphaMode alpha);

// Decodes a file that is in memory, as Blender keeps packed files.
scene::Image load_memory(const std::string& name, std::span<const char> data, bool srgb,
                         scene::AlphaMode alpha);

}  // namespace panoptes::image_io
