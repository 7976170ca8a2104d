#include "driver/occlusion_options.h"

#include "base/error.h"

#include <fmt/ranges.h>

#include <cstdlib>
#include <functional>
#include <map>

namespace panoptes::driver {

namespace {

template <class E, size_t N>
E named(const std::array<std::string_view, N>& names, const std::string& value) {
  const E found = ambient_occlusion::find_name<E>(names, value);
  if (!ambient_occlusion::known(names, found))
    fail("'{}' is none of {}: see --help", value, fmt::join(names, ", "));
  return found;
}

float number(const std::string& value) {
  char* end = nullptr;
  const float result = std::strtof(value.c_str(), &end);
  if (end == value.c_str() || *end) fail("'{}' is no number: see --help", value);
  return result;
}

}  // namespace

void set_occlusion(ambient_occlusion::Settings& s, const std::string& option) {
  namespace ao = ambient_occlusion;
  using Set = std::function<void(const std::string&)>;
  const std::map<std::string, Set> keys{
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
  const size_t at = option.find('=');
  const auto key = keys.find(option.substr(0, at));
  if (at == std::string::npos || key == keys.end())
    fail("--occlusion takes KEY=VALUE, not '{}': see --help", option);
  key->second(option.substr(at + 1));
}

}  // namespace panoptes::driver
