#include "rasterize/shadow_maps.h"

#include "gl/context.h"

#include <algorithm>

namespace panoptes::rasterize {

namespace {

constexpr const char* kTimerNames[5] = {"point_shadows", "sun_shadows", "spot_shadows",
                                        "area_shadows", "emissive_shadows"};

}  // namespace

int ShadowMaps::layer_limit(const ShadowSettings& settings, const gl::DeviceInfo& device) {
  const int64_t layer = int64_t(settings.resolution) * settings.resolution * 4;
  return int(std::clamp<int64_t>(settings.max_bytes / layer, 6, device.max_array_layers));
}

void ShadowMaps::render(const LightSet& set, const LightBatch& batch,
                        const ShadowSettings& settings, const shared::View& camera,
                        const gpu_scene::GpuScene& scene, gl::ProgramCache& programs,
                        gl::PassTimer& timer, gpu_scene::ViewBlock& view_block, bool keep) {
  if (maps_.resize(settings.resolution, settings.resolution, std::max(int(batch.layers), 1)))
    keep = false;
  if (keep) return;
  int layer = 0;
  for (uint32_t i = batch.first_light; i < batch.first_light + batch.light_count; ++i) {
    const PlacedLight& placed = set.lights[i];
    if (placed.views.empty()) continue;
    gl::PassScope scope(timer, kTimerNames[int(placed.kind)]);
    uint32_t face = placed.light.shadow;
    for (const auto& from : placed.views) {
      ++face;
      if (from)
        maps_.draw(layer++, *from, glm::ivec2(placed.resolution), float(face), camera, scene,
                   programs, view_block);
    }
  }
}

}  // namespace panoptes::rasterize
