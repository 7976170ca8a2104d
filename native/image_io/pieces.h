// Pieces of pictures (film/pieces.h) in OpenEXR files. A file's first part is the picture, under the
// names that Blender gives; behind it comes one part a piece, with a channel for each channel of each
// pass that is summed, in the first piece also of those that are not. A piece's channels are named
// after its part, "layer 1 samples 0-16.DiffDir.R": Blender would refuse a file with the same names in
// several parts, and lists the parts as layers after its own. What a piece is stands in its part's
// attributes "panoptes:...".
#pragma once

#include "film/pieces.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace panoptes::image_io {

struct LayerPieces {
  std::string layer;     // Blender's view layer
  std::string settings;  // what must agree for merging; any text
  std::shared_ptr<const film::Pieces> pieces;
};

// What a file holds of a layer.
struct LayerRange {
  std::string layer, settings;
  uint32_t first = 0, last = 0;  // samples, half-open
};

// Writes the picture of `source` to `target`, with `layers` behind it. Throws Error when one of the
// files cannot be used, or when a layer has another size than the picture.
void add_pieces(const std::string& source, const std::string& target,
                std::span<const LayerPieces> layers);

// The layers of which a file holds pieces, in its order; none for other pictures. Throws Error when
// it cannot be read.
std::vector<LayerRange> find_pieces(const std::string& path);

// Merges files whose layers' ranges follow on each other, in their order, into `target`: a picture
// like the first one's of all their samples, with its pieces. Returns the channels of that picture
// that were left out, as they come from no pass. Throws Error when files cannot be used or do not
// fit together.
std::vector<std::string> merge_pieces(std::span<const std::string> sources,
                                      const std::string& target);

}  // namespace panoptes::image_io
