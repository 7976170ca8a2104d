#include "rasterize/g_buffer.h"

#include "gl/context.h"

#include <fmt/format.h>

namespace panoptes::rasterize {

namespace {

constexpr int kBinBytes = 32;  // struct Bin of bins.glsl

int groups(int pixels) { return (pixels + 7) / 8; }

}  // namespace

gl::ProgramSource raster_program(const gpu_scene::GpuMaterial* material,
                                 const RasterProgramOptions& options) {
  gl::ProgramSource source;
  source.name = options.depth_only ? "shadow map" : "visibility";
  source.stages = {{GL_VERTEX_SHADER, "rasterize/raster.vert"},
                   {GL_FRAGMENT_SHADER, "rasterize/raster.frag"}};
  source.defines.push_back(fmt::format("DEPTH_ONLY {}", int(options.depth_only)));
  if (material) {
    source.name += fmt::format(" of material '{}'", material->name);
    gpu_scene::GpuScene::add_material(*material, source);
  } else {
    source.defines.push_back("ALPHA 0");
  }
  return source;
}

GBufferOptions GBufferOptions::of(const plan::Effects& plan) {
  return {.glossy = plan::runs(plan, "glossy"),
          .emission = plan::runs(plan, "emission"),
          .transmission = plan::runs(plan, "transmission"),
          .layers = plan::runs(plan, "layers")};
}

void GBufferOptions::add_defines(gl::ProgramSource& source) const {
  source.defines.push_back(fmt::format("GLOSSY {}", int(glossy)));
  source.defines.push_back(fmt::format("EMISSION {}", int(emission)));
  source.defines.push_back(fmt::format("TRANSMISSION {}", int(transmission)));
  source.defines.push_back(fmt::format("LAYERS {}", int(layers)));
}

int64_t GBufferOptions::record_bytes() const {
  return 16 * (2 + emission + 2 + 2 * (glossy + transmission + layers));
}

gl::ProgramSource surface_program(const gpu_scene::GpuMaterial& material,
                                  const GBufferOptions& options) {
  gl::ProgramSource source;
  source.name = fmt::format("surfaces of material '{}'", material.name);
  source.stages = {{GL_COMPUTE_SHADER, "rasterize/surfaces.comp"}};
  gpu_scene::GpuScene::add_material(material, source);
  options.add_defines(source);
  return source;
}

gl::ProgramSource bin_program(const char* name) {
  gl::ProgramSource source;
  source.name = name;
  source.stages = {{GL_COMPUTE_SHADER, fmt::format("rasterize/{}.comp", name)}};
  return source;
}

void GBuffer::resize(int width, int height, const GBufferOptions& options) {
  if (position_ && width == width_ && height == height_ && options == options_) return;
  // Old storage goes first, so that the peak is not the sum of both.
  *this = GBuffer();
  resize_visibility(width, height);
  const auto image = [&](GLenum format) {
    return gl::Texture({GL_TEXTURE_2D, format, width, height, 1, 1});
  };
  position_ = image(GL_RGBA32F);
  normals_ = image(GL_RGBA32UI);
  diffuse_ = image(GL_RGBA16F);
  if (options.glossy) specular_ = image(GL_RGBA16F);
  if (options.emission) emission_ = image(GL_RGBA32F);
  if (options.transmission) transmission_ = image(GL_RGBA32UI);
  if (options.layers) layers_ = image(GL_RGBA32UI);
  options_ = options;
}

void GBuffer::resize_visibility(int width, int height) {
  if (width == width_ && height == height_) return;
  *this = GBuffer();
  visibility_ = gl::Texture({GL_TEXTURE_2D, GL_RG32UI, width, height, 1, 1});
  depth_ = gl::Texture({GL_TEXTURE_2D, GL_DEPTH_COMPONENT32F, width, height, 1, 1});
  framebuffer_ = gl::Framebuffer::make();
  glNamedFramebufferTexture(framebuffer_.id(), GL_COLOR_ATTACHMENT0, visibility_.id(), 0);
  glNamedFramebufferTexture(framebuffer_.id(), GL_DEPTH_ATTACHMENT, depth_.id(), 0);
  width_ = width;
  height_ = height;
}

void GBuffer::rasterize(const gpu_scene::GpuScene& scene, gl::ProgramCache& programs,
                        gl::PassTimer& timer) {
  gl::PassScope scope(timer, "visibility");
  draw(gpu_scene::ViewKind::kCamera, scene, programs);
}

void GBuffer::draw(gpu_scene::ViewKind kind, const gpu_scene::GpuScene& scene,
                   gl::ProgramCache& programs) {
  records_ = &scene.records();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  glViewport(0, 0, width_, height_);
  const GLuint nothing[4] = {0, 0, 0, 0};
  const float far_depth = 0.0f;
  glClearNamedFramebufferuiv(framebuffer_.id(), GL_COLOR, 0, nothing);
  glClearNamedFramebufferfv(framebuffer_.id(), GL_DEPTH, 0, &far_depth);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_TRUE);
  if (!scene.empty())
    scene.draw(kind, [&](const gpu_scene::GpuMaterial* material) {
      programs.get(raster_program(material, {.depth_only = false})).use();
      if (material) scene.bind_shading(*material);
    });
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

void GBuffer::shade(const gpu_scene::GpuScene& scene, gl::ProgramCache& programs,
                    gl::PassTimer& timer) {
  {
    gl::PassScope scope(timer, "sort_pixels");
    sort_pixels(scene, programs);
  }
  gl::PassScope scope(timer, "surfaces");
  scene.bind_geometry();
  for (uint32_t m = 0; m < material_count_; ++m) {
    const gpu_scene::GpuMaterial& material = scene.materials()[m];
    programs.get(surface_program(material, options_)).use();
    scene.bind_shading(material);
    bind_bins();
    bind_visibility();
    position_.bind_image(0, GL_WRITE_ONLY);
    normals_.bind_image(1, GL_WRITE_ONLY);
    diffuse_.bind_image(2, GL_WRITE_ONLY);
    if (options_.glossy) specular_.bind_image(3, GL_WRITE_ONLY);
    if (options_.emission) emission_.bind_image(4, GL_WRITE_ONLY);
    if (options_.transmission) transmission_.bind_image(5, GL_WRITE_ONLY);
    if (options_.layers) layers_.bind_image(6, GL_WRITE_ONLY);
    glUniform1ui(2, m);
    dispatch_bin(m);
  }
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

void GBuffer::sort_pixels(const gpu_scene::GpuScene& scene, gl::ProgramCache& programs) {
  material_count_ = uint32_t(scene.materials().size());
  const int64_t bytes = int64_t(material_count_ + 2) * kBinBytes;
  if (bins_.bytes() < bytes) bins_ = gl::Buffer(bytes);
  bins_.clear();
  pixels_.reserve(int64_t(width_) * height_ * 4);
  const auto pass = [&](const char* name, int x, int y) {
    programs.get(bin_program(name)).use();
    bind_bins();
    bind_visibility();
    glDispatchCompute(GLuint(x), GLuint(y), 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
  };
  pass("bin_count", groups(width_), groups(height_));
  pass("bin_offsets", 1, 1);
  pass("bin_scatter", groups(width_), groups(height_));
}

void GBuffer::bind_bins() const {
  if (records_ && records_->id())
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, records_->id());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, bins_.id());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, pixels_.id());
  glUniform1ui(1, material_count_);
}

void GBuffer::bind_surfaces() const {
  position_.bind(9);
  normals_.bind(10);
  diffuse_.bind(11);
  if (options_.glossy) specular_.bind(12);
  if (options_.transmission) transmission_.bind(14);
  if (options_.layers) layers_.bind(15);
  // Samplers of material images may still sit on these units.
  for (GLuint unit = 9; unit <= 15; ++unit) glBindSampler(unit, 0);
}

void GBuffer::bind_visibility() const {
  visibility_.bind(gpu_scene::kFreeUnit);
  glBindSampler(gpu_scene::kFreeUnit, 0);
}

void GBuffer::dispatch_bin(uint32_t bin) const {
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, bins_.id());
  glDispatchComputeIndirect(GLintptr(bin) * kBinBytes);
}

void GBuffer::dispatch_surfaces() const { dispatch_bin(material_count_ + 1); }

void GBuffer::dispatch_background() const { dispatch_bin(material_count_); }

}  // namespace panoptes::rasterize
