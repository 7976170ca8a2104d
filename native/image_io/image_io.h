// Images from files and from memory through OpenImageIO; this folder is the only one that links it.
#pragma once

#include "scene/image.h"

#include <memory>
#include <string>

namespace panoptes::image_io {

// Decodes the file at `path`, with all levels. Values keep the type that they have in the file, grey
// stays grey; what is neither 8 or 16 bits nor a half becomes float. The image reloads from the file.
// Throws Error with the cause when it cannot be read.
scene::Image load_file(const std::string& name, const std::string& path, bool srgb,
                       scene::AlphaMode alpha);

// Decodes a file that is in memory, as Blender keeps packed files. The image reloads from `data`,
// which it keeps.
scene::Image load_memory(const std::string& name, std::shared_ptr<const std::string> data,
                         bool srgb, scene::AlphaMode alpha);

}  // namespace panoptes::image_io
