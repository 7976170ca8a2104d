#include "radiance_cache/reflective_maps.h"

#include "base/cancelled.h"
#include "gl/dispatch.h"
#include "rasterize/shadow_face.h"

#include <algorithm>

namespace panoptes::radiance_cache {

namespace {

// llvmpipe cuts an invocation off after 65 535 iterations of loops; this leaves room for those that
// are not counted here.
constexpr uint32_t kMostIterations = 40'000;
// Of one sample, besides its march, at most: tries to find a place in the cell, and harmonics.
constexpr uint32_t kSampleIterations = 200;

float radical_inverse(int base, int index) {
  double result = 0, place = 1;
  for (; index > 0; index /= base) {
    place /= base;
    result += place * (index % base);
  }
  return float(result);
}

void reserve(gl::Buffer& buffer, gl::Texture& texels, GLenum format, int64_t bytes) {
  if (buffer.reserve(bytes)) texels = gl::Texture(format, buffer);
}

bool mesh(const rasterize::PlacedLight& placed) {
  return placed.kind == rasterize::ShadowKind::kMesh;
}

// The faces of a cube overlap by a border that shadow maps filter across; what lies there would send
// light on twice.
gpu_scene::LightView without_border(gpu_scene::LightView view, size_t faces) {
  if (faces == shared::CUBE_FACES) view.half_x = view.half_y = 1;
  return view;
}

}  // namespace

std::vector<glm::vec2> halton_points(int count) {
  std::vector<glm::vec2> points;
  for (int i = 1; i <= count; ++i) points.emplace_back(radical_inverse(2, i), radical_inverse(3, i));
  return points;
}

void ReflectiveMaps::store_points(int count) {
  const int64_t bytes = count * int64_t(sizeof(glm::vec2));
  if (!points_.reserve(bytes)) return;
  points_texels_ = gl::Texture(GL_RG32F, points_);
  points_.write(0, bytes, halton_points(count).data());
}

void ReflectiveMaps::release() {
  g_buffer_ = rasterize::GBuffer();
  for (gl::Texture* texels : {&places_texels_, &flux_texels_, &points_texels_, &light_texels_})
    *texels = gl::Texture();
  for (gl::Buffer* buffer : {&lights_, &places_, &flux_, &points_, &light_}) *buffer = gl::Buffer();
}

void ReflectiveMaps::update(const Lamps& lamps, const Cells& cells, const Settings& settings) {
  reserve(light_, light_texels_, GL_RGBA32F, std::max(int64_t(cells.count), int64_t(1)) * 9 * 16);
  light_.clear();
  const auto& lights = lamps.set.lights;
  if (cells.count == 0 || lights.empty()) return;
  resolution_ = settings.rsm_resolution;
  const int64_t texels = int64_t(resolution_) * resolution_;
  reserve(places_, places_texels_, GL_RGBA32UI, texels * 16);
  reserve(flux_, flux_texels_, GL_R32UI, texels * 4);
  store_points(settings.rsm_samples);
  std::vector<shared::Light> described;
  for (const rasterize::PlacedLight& placed : lights) described.push_back(placed.light);
  const int64_t bytes = int64_t(described.size() * sizeof(shared::Light));
  lights_.reserve(bytes);
  lights_.write(0, bytes, described.data());

  // Points of glowing surfaces share the samples of one lamp.
  const auto meshes = std::count_if(lights.begin(), lights.end(), mesh);
  uint32_t number = 0;
  for (uint32_t lamp = 0; lamp < lights.size(); ++lamp) {
    const auto& views = lights[lamp].views;
    const auto faces = std::count_if(views.begin(), views.end(), [](auto& v) { return v.has_value(); });
    const auto share = std::max(faces * (mesh(lights[lamp]) ? meshes : 1), std::ptrdiff_t(1));
    const auto samples = uint32_t((settings.rsm_samples + share - 1) / share);
    for (const auto& view : views) {
      ++number;
      if (!view) continue;
      const gpu_scene::LightView face = without_border(*view, views.size());
      draw(lamps, lamp, face, number, cells);
      gather(face, samples, number, cells, settings);
      stop_if(lamps.cancelled);
    }
  }
}

void ReflectiveMaps::draw(const Lamps& lamps, uint32_t lamp, const gpu_scene::LightView& from,
                          uint32_t number, const Cells& cells) {
  gl::PassScope scope(timer_, "cache_rsm_maps");
  shared::View view = gpu_scene::light_view(from, glm::ivec2(resolution_));
  view.size.z = lamps.camera.size.z;
  view.size.w = lamps.camera.size.w;
  view.alpha = {lamps.camera.alpha.x, float(number), 0, 0};
  view.filtering.x = lamps.camera.filtering.x;
  lamps.view_block.set(view);
  g_buffer_.resize_visibility(resolution_, resolution_);
  g_buffer_.draw(gpu_scene::ViewKind::kShadow, lamps.gpu, programs_);
  g_buffer_.sort_pixels(lamps.gpu, programs_);
  flux_.clear();  // texels that show nothing send nothing
  lamps.gpu.bind_geometry();
  const glm::vec3 to_lamps(from.origin - lamps.origin), to_list(from.origin - cells.origin);
  const auto& materials = lamps.gpu.materials();
  for (uint32_t m = 0; m < materials.size(); ++m) {
    programs_.get(rsm_surfaces_program(materials[m])).use();
    lamps.gpu.bind_shading(materials[m]);
    g_buffer_.bind_bins();
    g_buffer_.bind_visibility();
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, lights_.id());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 4, places_.id());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 5, flux_.id());
    glUniform1ui(2, m);
    glUniform1ui(3, lamp);
    glUniform3fv(4, 1, &to_lamps.x);
    glUniform3fv(5, 1, &to_list.x);
    g_buffer_.dispatch_material(m);
  }
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

void ReflectiveMaps::gather(const gpu_scene::LightView& view, uint32_t samples, uint32_t number,
                            const Cells& cells, const Settings& settings) {
  gl::PassScope scope(timer_, "cache_rsm_gather");
  programs_.get(rsm_gather_program(settings.rsm_mixed, settings.march_steps, settings.walls)).use();
  cells.bind();
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, light_.id());
  places_texels_.bind(1);
  flux_texels_.bind(2);
  points_texels_.bind(3);
  const shared::ShadowFace face =
      rasterize::shadow_face(view, cells.origin, glm::ivec2(resolution_));
  const glm::vec4 frame[4] = {face.x, face.y, face.axis, face.origin};
  glUniform3ui(0, cells.count, cells.seed, unsigned(resolution_));
  glUniform1f(5, settings.rsm_spread);
  glUniform4fv(6, 4, &frame[0].x);
  glUniform1ui(10, number);
  const uint32_t march = settings.march_steps ? uint32_t(settings.march_steps) : cells.longest_march;
  const uint32_t at_once = std::max(kMostIterations / (march + kSampleIterations), 1u);
  for (uint32_t first = 0; first < samples; first += at_once) {
    glUniform3ui(4, samples, first, std::min(first + at_once, samples));
    gl::dispatch(cells.count, GL_SHADER_STORAGE_BARRIER_BIT);
  }
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

}  // namespace panoptes::radiance_cache
