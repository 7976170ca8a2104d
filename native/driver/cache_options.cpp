#include "driver/cache_options.h"

#include "driver/options.h"

namespace panoptes::driver {

void set_cache(radiance_cache::Settings& s, const std::string& option) {
  namespace rc = radiance_cache;
  const Options keys{
      {"encoding", [&](auto& v) { s.encoding = named<rc::Encoding>(rc::kEncodingNames, v); }},
      {"first_bounce", [&](auto& v) { s.first_bounce = named<rc::FirstBounce>(rc::kFirstBounceNames, v); }},
      {"occupancy", [&](auto& v) { s.occupancy = named<rc::Occupancy>(rc::kOccupancyNames, v); }},
      {"picture", [&](auto& v) { s.picture = named<rc::Picture>(rc::kPictureNames, v); }},
      {"enabled", [&](auto& v) { s.enabled = number(v) != 0; }},
      {"bounces", [&](auto& v) { s.bounces = int(number(v)); }},
      {"resolution", [&](auto& v) { s.resolution = int(number(v)); }},
      {"voxels", [&](auto& v) { s.voxels = int(number(v)); }},
      {"cascades", [&](auto& v) { s.cascades = int(number(v)); }},
      {"luminance", [&](auto& v) { s.luminance = number(v); }},
      {"chrominance", [&](auto& v) { s.chrominance = number(v); }},
      {"directions", [&](auto& v) { s.directions = int(number(v)); }},
      {"march_steps", [&](auto& v) { s.march_steps = int(number(v)); }},
      {"voxel_fill", [&](auto& v) { s.voxel_fill = number(v); }},
      {"depth_stride", [&](auto& v) { s.depth_stride = int(number(v)); }},
      {"walls", [&](auto& v) { s.walls = number(v) != 0; }},
      {"dilate", [&](auto& v) { s.dilate = number(v) != 0; }},
      {"rsm_samples", [&](auto& v) { s.rsm_samples = int(number(v)); }},
      {"rsm_resolution", [&](auto& v) { s.rsm_resolution = int(number(v)); }},
      {"rsm_spread", [&](auto& v) { s.rsm_spread = number(v); }},
      {"rsm_mixed", [&](auto& v) { s.rsm_mixed = number(v) != 0; }},
      {"blend", [&](auto& v) { s.blend = number(v); }},
      {"rebuild_every", [&](auto& v) { s.rebuild_every = int(number(v)); }}};
  set_option(keys, option, "--cache");
}

}  // namespace panoptes::driver
