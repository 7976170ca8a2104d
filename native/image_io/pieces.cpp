#include "image_io/pieces.h"

#include "base/error.h"
#include "image_io/planes.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <map>
#include <memory>

namespace panoptes::image_io {

namespace {

using film::Pass;

constexpr const char* kLayer = "panoptes:layer";
constexpr const char* kSettings = "panoptes:settings";
constexpr const char* kFirst = "panoptes:first";
constexpr const char* kLast = "panoptes:last";
constexpr const char* kExposure = "panoptes:exposure";

std::unique_ptr<OIIO::ImageInput> open_picture(const std::string& path) {
  auto input = OIIO::ImageInput::open(path);
  if (!input)
    fail("'{}' cannot be read ({}): give an OpenEXR picture that render has written", path,
         OIIO::geterror());
  return input;
}

bool is_piece_part(const OIIO::ImageSpec& spec) { return spec.find_attribute(kLayer) != nullptr; }

std::string text_of(const OIIO::ImageSpec& spec, const char* attribute) {
  return std::string(spec.get_string_attribute(attribute));
}

// Calls `use` with the spec of each part that holds a piece, the input standing there.
template <class F>
void for_pieces(OIIO::ImageInput& input, F&& use) {
  for (int part = 1; input.seek_subimage(part, 0); ++part)
    if (is_piece_part(input.spec())) use(input.spec());
  OIIO::geterror();  // there is no part behind the last one
}

std::string channel_name(const std::string& part, Pass pass, int channel) {
  const film::PassInfo& p = film::info(pass);
  return fmt::format("{}.{}.{}", part, p.name, p.channels == 1 ? 'Z' : "RGBA"[channel]);
}

void add_planes(std::vector<Plane>& planes, const std::string& part, Pass pass,
                const float* values) {
  const int channels = film::info(pass).channels;
  for (int c = 0; c < channels; ++c)
    planes.push_back({channel_name(part, pass, c), values + c, size_t(channels)});
}

// The channels of a piece; `begins` says that it is the first one.
std::vector<Plane> planes_of(const film::Pieces& pieces, const film::Piece& piece, bool begins,
                             const std::string& part) {
  std::vector<Plane> planes;
  const film::Layout layout = pieces.layout();
  for (int i = 0; i < film::kPassCount; ++i)
    if (layout.holds(Pass(i)))
      add_planes(planes, part, Pass(i), piece.sums.data() + layout.begin(Pass(i)));
  if (begins)
    for (const auto& [pass, values] : pieces.firsts) add_planes(planes, part, pass, values.data());
  return planes;
}

OIIO::ImageSpec piece_spec(const LayerPieces& layer, const film::Piece& piece,
                           const std::vector<Plane>& planes, const std::string& part) {
  OIIO::ImageSpec spec(layer.pieces->width, layer.pieces->height, int(planes.size()),
                       OIIO::TypeDesc::FLOAT);
  for (size_t i = 0; i < planes.size(); ++i) spec.channelnames[i] = planes[i].name;
  spec.attribute("compression", "zip");
  spec.attribute("oiio:subimagename", part);
  spec.attribute(kLayer, layer.layer);
  spec.attribute(kSettings, layer.settings);
  spec.attribute(kFirst, int(piece.first));
  spec.attribute(kLast, int(piece.last));
  spec.attribute(kExposure, layer.pieces->exposure);
  return spec;
}

// A picture's spec as that of the first part of several.
OIIO::ImageSpec picture_spec(OIIO::ImageSpec spec) {
  for (const char* name : {"name", "oiio:subimages", "openexr:chunkCount"})
    spec.erase_attribute(name);
  spec.attribute("oiio:subimagename", "picture");
  return spec;
}

// Writes the picture by `write_picture(output)`, then all pieces.
template <class F>
void write_file(const std::string& target, OIIO::ImageSpec picture,
                std::span<const LayerPieces> layers, F&& write_picture) {
  std::vector<OIIO::ImageSpec> specs{picture_spec(std::move(picture))};
  std::vector<std::vector<Plane>> parts;
  for (size_t i = 0; i < layers.size(); ++i)
    for (const film::SampleSums& sums = layers[i].pieces->sums;
         const film::Piece& piece : sums.pieces()) {
      const std::string part =
          fmt::format("layer {} samples {}-{}", i + 1, piece.first, piece.last);
      parts.push_back(planes_of(*layers[i].pieces, piece, piece.first == sums.first(), part));
      specs.push_back(piece_spec(layers[i], piece, parts.back(), part));
    }
  auto output = OIIO::ImageOutput::create("openexr");
  const auto check = [&](bool done) {
    if (!done)
      fail("'{}' cannot be written ({}): check the folder and the free space", target,
           output ? output->geterror() : OIIO::geterror());
  };
  check(output && output->open(target, int(specs.size()), specs.data()));
  write_picture(*output);
  for (size_t i = 0; i < parts.size(); ++i) {
    check(output->open(target, specs[i + 1], OIIO::ImageOutput::AppendSubimage));
    write_planes(*output, target, parts[i]);
  }
  check(output->close());
}

int channel_index(const OIIO::ImageSpec& spec, Pass pass, int channel) {
  const std::string part = text_of(spec, "oiio:subimagename");
  return spec.channelindex(channel_name(part, pass, channel));
}

// The passes whose channels a part has.
film::PassSet passes_in(const OIIO::ImageSpec& spec) {
  film::PassSet passes;
  for (int i = 0; i < film::kPassCount; ++i)
    passes[size_t(i)] = channel_index(spec, Pass(i), 0) >= 0;
  return passes;
}

void add_targets(std::vector<Target>& targets, const OIIO::ImageSpec& spec, const std::string& path,
                 Pass pass, float* values) {
  const int channels = film::info(pass).channels;
  for (int c = 0; c < channels; ++c) {
    const int index = channel_index(spec, pass, c);
    if (index < 0)
      fail("'{}' lacks channels of pass '{}': render it again", path, film::info(pass).name);
    targets.push_back({index, values + c, size_t(channels)});
  }
}

// Adds the piece where `input` stands to a layer.
void take_up(OIIO::ImageInput& input, const std::string& path, film::Pieces& pieces) {
  const OIIO::ImageSpec& spec = input.spec();
  const film::PassSet passes = passes_in(spec);
  const float exposure = spec.get_float_attribute(kExposure, 1.0f);
  const film::Layout layout(size_t(spec.width) * size_t(spec.height), passes);
  std::vector<Target> targets;
  if (pieces.sums.empty()) {
    pieces = {spec.width, spec.height, exposure, passes, {}, {}};
    for (int i = 0; i < film::kPassCount; ++i)
      if (passes[size_t(i)] && !layout.holds(Pass(i))) {
        std::vector<float>& values = pieces.firsts[Pass(i)];
        values.resize(layout.size(Pass(i)));
        add_targets(targets, spec, path, Pass(i), values.data());
      }
  }
  film::Piece piece{uint32_t(spec.get_int_attribute(kFirst)),
                    uint32_t(spec.get_int_attribute(kLast)), std::vector<float>(layout.total())};
  const film::Layout known = pieces.layout();
  bool fits = spec.width == pieces.width && spec.height == pieces.height &&
              exposure == pieces.exposure;
  for (int i = 0; i < film::kPassCount; ++i) {
    fits = fits && layout.holds(Pass(i)) == known.holds(Pass(i));
    if (layout.holds(Pass(i)))
      add_targets(targets, spec, path, Pass(i), piece.sums.data() + layout.begin(Pass(i)));
  }
  if (!fits) fail("'{}' has another size, other passes or another exposure: render it again", path);
  read_planes(input, path, targets);
  pieces.sums.add(std::move(piece));
}

// A pass of the picture that pieces make; black for one that they do not have, since no method fills
// them all.
std::vector<float> picture_of(const film::Pieces& pieces, Pass pass) {
  const film::Layout layout = pieces.layout();
  const film::SampleCounts counts{pieces.sums.last() - pieces.sums.first(), {}};
  if (film::info(pass).kind == film::PassKind::kNoisy) return picture_of(pieces, Pass::kCombined);
  if (film::info(pass).kind == film::PassKind::kSamples)
    return film::sample_shares(counts, size_t(pieces.width) * size_t(pieces.height));
  if (const auto first = pieces.firsts.find(pass); first != pieces.firsts.end())
    return first->second;
  if (!layout.holds(pass)) return std::vector<float>(layout.size(pass));
  const auto total = [&](Pass of) {
    return pieces.sums.total(layout.begin(of), layout.size(of));
  };
  const Pass divisor = film::info(pass).divisor;
  return film::average(pass, total(pass), divisor == pass ? std::vector<float>() : total(divisor),
                       counts, pieces.exposure);
}

// The pictures of a layer as channels with Blender's names, "LAYER.PASS.R", that `spec` has.
void add_picture(const LayerPieces& layer, const OIIO::ImageSpec& spec, std::vector<Plane>& planes,
                 std::vector<std::vector<float>>& values) {
  for (int i = 0; i < film::kPassCount; ++i) {
    const film::PassInfo& p = film::kPasses[size_t(i)];
    const std::string start = fmt::format("{}.{}.", layer.layer, p.name);
    std::vector<float> picture;
    for (const std::string& name : spec.channelnames) {
      if (!name.starts_with(start) || name.size() != start.size() + 1) continue;
      size_t channel = 0;
      if (p.channels > 1)
        channel = std::min(std::string_view("RGBA").find(name.back()),
                           std::string_view("XYZ").find(name.back()));
      if (channel >= size_t(p.channels)) continue;
      if (picture.empty()) picture = picture_of(*layer.pieces, Pass(i));
      planes.push_back({name, picture.data() + channel, size_t(p.channels)});
    }
    // The planes point into the vector's own storage, which moving leaves in place.
    if (!picture.empty()) values.push_back(std::move(picture));
  }
}

}  // namespace

void add_pieces(const std::string& source, const std::string& target,
                std::span<const LayerPieces> layers) {
  const auto input = open_picture(source);
  const OIIO::ImageSpec spec = input->spec();
  for (const LayerPieces& layer : layers)
    if (layer.pieces->width != spec.width || layer.pieces->height != spec.height)
      fail("the file's picture has {}x{} pixels, of which {}x{} were rendered: render the whole picture, "
           "or crop it to the render region",
           spec.width, spec.height, layer.pieces->width, layer.pieces->height);
  write_file(target, spec, layers,
             [&](OIIO::ImageOutput& output) { copy_picture(*input, source, output, target); });
}

std::vector<LayerRange> find_pieces(const std::string& path) {
  std::vector<LayerRange> layers;
  const auto input = open_picture(path);
  for_pieces(*input, [&](const OIIO::ImageSpec& spec) {
    const std::string name = text_of(spec, kLayer);
    const uint32_t first = uint32_t(spec.get_int_attribute(kFirst));
    const auto known = std::find_if(layers.begin(), layers.end(),
                                    [&](const LayerRange& layer) { return layer.layer == name; });
    LayerRange& layer =
        known != layers.end()
            ? *known
            : layers.emplace_back(
                  LayerRange{name, text_of(spec, kSettings), first, first});
    layer.last = uint32_t(spec.get_int_attribute(kLast));
  });
  return layers;
}

std::vector<std::string> merge_pieces(std::span<const std::string> sources,
                                      const std::string& target) {
  if (sources.empty()) fail("there is nothing to merge: name at least one file");
  std::vector<LayerPieces> layers;
  std::map<std::string, std::shared_ptr<film::Pieces>> merged;
  for (const std::string& source : sources) {
    const auto input = open_picture(source);
    for_pieces(*input, [&](const OIIO::ImageSpec& spec) {
      const std::string name = text_of(spec, kLayer);
      std::shared_ptr<film::Pieces>& pieces = merged[name];
      if (!pieces) {
        pieces = std::make_shared<film::Pieces>();
        layers.push_back({name, text_of(spec, kSettings), pieces});
      }
      take_up(*input, source, *pieces);
    });
  }
  OIIO::ImageSpec spec = open_picture(sources.front())->spec();
  std::vector<Plane> planes;
  std::vector<std::vector<float>> values;
  for (const LayerPieces& layer : layers) add_picture(layer, spec, planes, values);
  std::vector<std::string> left_out;
  for (const std::string& name : spec.channelnames)
    if (std::none_of(planes.begin(), planes.end(), [&](const Plane& p) { return p.name == name; }))
      left_out.push_back(name);
  if (planes.empty())
    fail("'{}' has no picture of the layers that its pieces are of: render it again",
         sources.front());
  spec.nchannels = int(planes.size());
  spec.channelnames.clear();
  spec.channelformats.clear();
  for (const Plane& plane : planes) spec.channelnames.push_back(plane.name);
  write_file(target, spec, layers,
             [&](OIIO::ImageOutput& output) { write_planes(output, target, planes); });
  return left_out;
}

}  // namespace panoptes::image_io
