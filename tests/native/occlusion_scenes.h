// Scenes whose ambient occlusion is known, and renders of it.
#pragma once

#include "support.h"

#include <cmath>

namespace panoptes::test {

using ambient_occlusion::Estimator;

constexpr Estimator kEstimators[] = {Estimator::kAlchemy, Estimator::kSsao, Estimator::kHbao};

// Share of the light from a white hemisphere that a wall without end takes, `k` times r_max away: a
// direction meets the wall within r_max where its part towards the wall is more than k, which on
// the unit disk below the hemisphere is a segment.
inline double wall_occlusion(double k) {
  return k >= 1 ? 0 : (std::acos(k) - k * std::sqrt(1 - k * k)) / kPi;
}

// A white floor, x >= 0, and a white wall in the plane x = 0 that stands on it.
inline TestScene corner() {
  TestScene s;
  const Id white = s.add_material(lambert());
  s.add_object(quad({8, 0, 0}, {8, 0, 0}, {0, 8, 0}), {white});
  s.add_object(quad({0, 0, 8}, {0, 8, 0}, {0, 0, 8}), {white});
  return s;
}

// Asks for the AO pass by the camera alone, without a filter.
inline engine::RenderRequest occluded(const gpu_scene::Camera& camera, float distance,
                                      uint32_t samples = 1) {
  engine::RenderRequest r = request(camera, {film::Pass::kAo}, samples);
  r.occlusion.distance = distance;
  r.occlusion.secondary_views = 0;
  r.occlusion.phantoms = ambient_occlusion::Phantoms::kOff;
  r.occlusion.filter = ambient_occlusion::Filter::kOff;
  return r;
}

// The same traced: without error but for noise.
inline engine::RenderRequest traced(engine::RenderRequest r, uint32_t samples) {
  r.method = engine::Method::kPrimitive;
  r.paths.ao_distance = r.occlusion.distance;
  r.last_sample = samples;
  return r;
}

inline plan::Effect effect_of(const Picture& picture, const std::string& name) {
  for (const engine::EffectReport& effect : picture.stats.effects)
    if (effect.name == name) return effect;
  throw Error("no effect " + name);
}

// Root mean square of the difference of two AO passes.
inline double rmse(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += (double(a[i]) - b[i]) * (double(a[i]) - b[i]);
  return std::sqrt(sum / double(a.size()));
}

}  // namespace panoptes::test
