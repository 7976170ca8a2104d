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
  const int layers = std::max(int(batch.layers), 1);
  if (!maps_ || maps_.options().layers < layers ||
      maps_.options().width != settings.resolution) {
    maps_ = gl::Texture();
    maps_ = gl::Texture({GL_TEXTURE_2D_ARRAY, GL_DEPTH_COMPONENT32F, settings.resolution,
                         settings.resolution, layers, 1});
    framebuffer_ = gl::Framebuffer::make();
    glNamedFramebufferDrawBuffer(framebuffer_.id(), GL_NONE);
    sampler_ = gl::Sampler({GL_NEAREST, GL_NEAREST, GL_CLAMP_TO_EDGE, GL_CLAMP_TO_EDGE});
    keep = false;
  }
  if (keep || batch.layers == 0) return;

  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  glEnable(GL_SCISSOR_TEST);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_TRUE);
  int layer = 0;
  for (uint32_t i = batch.first_light; i < batch.first_light + batch.light_count; ++i) {
    const PlacedLight& placed = set.lights[i];
    if (placed.views.empty()) continue;
    gl::PassScope scope(timer, kTimerNames[int(placed.kind)]);
    uint32_t face = placed.light.shadow;
    glViewport(0, 0, placed.resolution, placed.resolution);
    glScissor(0, 0, placed.resolution, placed.resolution);
    for (const auto& from : placed.views) {
      ++face;
      if (!from) continue;
      shared::View view = gpu_scene::light_view(*from, placed.resolution);
      view.size.z = camera.size.z;
      view.size.w = camera.size.w;
      view.alpha = {camera.alpha.x, float(face), 0, 0};
      view.filtering.x = camera.filtering.x;
      view_block.set(view);
      glNamedFramebufferTextureLayer(framebuffer_.id(), GL_DEPTH_ATTACHMENT, maps_.id(), 0,
                                     layer++);
      const float far_depth = 0.0f;
      glClearNamedFramebufferfv(framebuffer_.id(), GL_DEPTH, 0, &far_depth);
      if (!scene.empty())
        scene.draw(gpu_scene::ViewKind::kShadow, [&](const gpu_scene::GpuMaterial* material) {
          programs.get(raster_program(material, {.depth_only = true})).use();
          if (material) scene.bind_shading(*material);
        });
    }
  }
  glDisable(GL_SCISSOR_TEST);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

void ShadowMaps::bind(int unit) const {
  maps_.bind(unit);
  sampler_.bind(unit);
}

void ShadowMaps::release() {
  maps_ = gl::Texture();
  framebuffer_ = gl::Framebuffer();
}

}  // namespace panoptes::rasterize
