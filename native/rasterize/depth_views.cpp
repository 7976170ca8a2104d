#include "rasterize/depth_views.h"

#include "rasterize/g_buffer.h"

namespace panoptes::rasterize {

bool DepthViews::resize(int width, int height, int layers) {
  const gl::TextureOptions& has = maps_.options();
  if (maps_ && has.width == width && has.height == height && has.layers >= layers) return false;
  maps_ = gl::Texture();  // old storage goes first, so that the peak is not the sum of both
  maps_ = gl::Texture({GL_TEXTURE_2D_ARRAY, GL_DEPTH_COMPONENT32F, width, height, layers, 1});
  framebuffer_ = gl::Framebuffer::make();
  glNamedFramebufferDrawBuffer(framebuffer_.id(), GL_NONE);
  sampler_ = gl::Sampler({GL_NEAREST, GL_NEAREST, GL_CLAMP_TO_EDGE, GL_CLAMP_TO_EDGE});
  return true;
}

void DepthViews::draw(int layer, const gpu_scene::LightView& from, glm::ivec2 texels, float number,
                      const shared::View& camera, const gpu_scene::GpuScene& scene,
                      gl::ProgramCache& programs, gpu_scene::ViewBlock& view_block) const {
  shared::View view = gpu_scene::light_view(from, texels);
  view.size.z = camera.size.z;
  view.size.w = camera.size.w;
  view.alpha = {camera.alpha.x, number, 0, 0};
  view.filtering.x = camera.filtering.x;
  view_block.set(view);

  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  glNamedFramebufferTextureLayer(framebuffer_.id(), GL_DEPTH_ATTACHMENT, maps_.id(), 0, layer);
  glViewport(0, 0, texels.x, texels.y);
  glScissor(0, 0, texels.x, texels.y);  // so that no more than these is cleared
  glEnable(GL_SCISSOR_TEST);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_TRUE);
  const float far_depth = 0.0f;
  glClearNamedFramebufferfv(framebuffer_.id(), GL_DEPTH, 0, &far_depth);
  if (!scene.empty())
    scene.draw(gpu_scene::ViewKind::kShadow, [&](const gpu_scene::GpuMaterial* material) {
      programs.get(raster_program(material, {.depth_only = true})).use();
      if (material) scene.bind_shading(*material);
    });
  glDisable(GL_SCISSOR_TEST);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void DepthViews::bind(int unit) const {
  maps_.bind(unit);
  sampler_.bind(unit);
}

}  // namespace panoptes::rasterize
