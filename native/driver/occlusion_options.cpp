#include "driver/occlusion_options.h"

#include "driver/options.h"

namespace panoptes::driver {

void set_occlusion(ambient_occlusion::Settings& s, const std::string& option) {
  namespace ao = ambient_occlusion;
  const Options keys{
      {"estimator", [&](auto& v) { s.estimator = named<ao::Estimator>(ao::kEstimatorNames, v); }},
      {"distance", [&](auto& v) { s.distance = number(v); }},
      {"strength", [&](auto& v) { s.strength = number(v); }},
      {"samples", [&](auto& v) { s.samples = int(number(v)); }},
      {"importance_sampling", [&](auto& v) { s.importance_sampling = number(v) != 0; }},
      {"initial_samples", [&](auto& v) { s.initial_samples = int(number(v)); }},
      {"secondary_views", [&](auto& v) { s.secondary_views = int(number(v)); }},
      {"phantoms", [&](auto& v) { s.phantoms = named<ao::Phantoms>(ao::kPhantomsNames, v); }},
      {"phantom_resolution", [&](auto& v) { s.phantom_resolution = int(number(v)); }},
      {"filter", [&](auto& v) { s.filter = named<ao::Filter>(ao::kFilterNames, v); }},
      {"deep_shadows", [&](auto& v) { s.deep_shadows = number(v); }},
      {"picture", [&](auto& v) { s.picture = named<ao::Picture>(ao::kPictureNames, v); }}};
  set_option(keys, option, "--occlusion");
}

}  // namespace panoptes::driver
