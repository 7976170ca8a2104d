#include "rasterize/emitter_lights.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace panoptes::rasterize {

namespace {

constexpr double kPi = 3.14159265358979323846;

// Points by which an emitter's power is measured: enough to find out which of a texture's emitters
// deserve samples; a misjudged power costs noise, never light, unless it comes out as nothing.
constexpr uint32_t kProbes = 32;

// Triangles that the shadow maps of a sample's points may draw: about what the rest of a sample of a
// large scene costs.
constexpr int64_t kTriangles = 1'000'000;

double brightness(const glm::vec4& radiance) {
  return 0.2126 * radiance.x + 0.7152 * radiance.y + 0.0722 * radiance.z;
}

}  // namespace

void EmitterLights::clear() {
  emitters_.clear();
  cumulative_.clear();
  lights_.clear();
  block_ = ~0u;
}

void EmitterLights::update(const scene::Scene& scene, const Gpu& gpu) {
  clear();
  const std::vector<scene::Emitter> all = scene::find_emitters(scene);
  std::vector<Draw> probes;
  for (size_t e = 0; e < all.size(); ++e)
    for (uint32_t i = 0; i < kProbes; ++i) {
      // Evenly spread (Roberts' R2 sequence), the same whenever the same emitter is measured.
      const double u = 0.5 + i * 0.7548776662466927, v = 0.5 + i * 0.5698402909980532;
      probes.push_back({all[e].sample(float(u - std::floor(u)), float(v - std::floor(v))), e, 0.0});
    }
  for (const scene::Emitter& emitter : all) emitters_.push_back({emitter, 0.0, 0.0});
  const std::vector<shared::EmitterRadiance> measured = radiances(probes, gpu);
  for (size_t i = 0; i < probes.size(); ++i)
    emitters_[probes[i].source].power +=
        (brightness(measured[i].front) + brightness(measured[i].back)) / kProbes;
  for (Source& source : emitters_) source.power *= source.emitter.area();
  std::erase_if(emitters_, [](const Source& s) { return !(s.power > 0 && std::isfinite(s.power)); });
  choose_probabilities();

  const int64_t triangles = std::max<int64_t>(scene.facts().triangles, 1);
  const size_t least = std::min<size_t>(emitters_.size(), 4);
  const uint32_t most = uint32_t(std::clamp<int64_t>(kTriangles / triangles, 1, kMostPoints));
  affordable_ = std::bit_ceil(std::max(uint32_t(least), std::bit_floor(most)));
}

void EmitterLights::choose_probabilities() {
  double total = 0, sum = 0;
  for (const Source& source : emitters_) total += source.power;
  for (Source& source : emitters_) {
    source.probability = 0.5 * source.power / total + 0.5 / double(emitters_.size());
    cumulative_.push_back(sum += source.probability);
  }
}

void EmitterLights::start(PointSequence sequence, bool single) {
  sequence_ = std::move(sequence);
  single_ = single;
  points_ = single ? kMostPoints : affordable_;
  lights_.clear();
}

EmitterLights::Draw EmitterLights::draw(uint32_t index) const {
  const glm::vec2 point = sequence_(index);
  const double target = double(point.x) * cumulative_.back();
  const auto above = std::upper_bound(cumulative_.begin(), cumulative_.end(), target);
  const size_t e = std::min(size_t(above - cumulative_.begin()), emitters_.size() - 1);
  // What is left of x is a number of its own.
  const Source& source = emitters_[e];
  const double low = e > 0 ? cumulative_[e - 1] : 0.0;
  const float u = float(std::clamp((target - low) / source.probability, 0.0, 1.0));
  return {source.emitter.sample(u, point.y), e,
          source.emitter.area() / (source.probability * points_)};
}

std::vector<shared::EmitterRadiance> EmitterLights::radiances(const std::vector<Draw>& draws,
                                                              const Gpu& gpu) const {
  std::vector<EmitterProbe> probes;
  for (const Draw& draw : draws) {
    const scene::EmitterPoint& p = draw.point;
    probes.push_back({emitters_[draw.source].emitter.material(),
                      {gpu.scene.place_of(p.instance), p.triangle, p.barycentrics.x, p.barycentrics.y}});
  }
  gpu.view_block.set(gpu.view);
  return emitted_radiance(probes, gpu.scene, gpu.programs);
}

const std::vector<MeshLight>& EmitterLights::sample(uint32_t index, const Gpu& gpu) {
  if (index / kBlock != block_ || lights_.empty()) {
    block_ = index / kBlock;
    const uint32_t samples = single_ ? 1 : kBlock;
    const uint32_t first = single_ ? index : block_ * kBlock;
    std::vector<Draw> draws;
    for (uint32_t i = first * points_; i < (first + samples) * points_; ++i)
      draws.push_back(draw(i));
    const std::vector<shared::EmitterRadiance> light = radiances(draws, gpu);
    lights_.assign(samples, {});
    for (uint32_t i = 0; i < draws.size(); ++i) {
      const Draw& d = draws[i];
      // The area that falls to each of the points up to this sample, as a disk.
      const uint32_t sample = i / points_;
      const double reach = std::sqrt(d.area / (kPi * double(first + sample + 1)));
      lights_[sample].push_back({d.point.position, d.point.normal,
                                 glm::vec3(light[i].front) * float(d.area),
                                 glm::vec3(light[i].back) * float(d.area), float(reach)});
    }
  }
  return lights_[single_ ? 0 : index % kBlock];
}

}  // namespace panoptes::rasterize
