#include "path_tracer/map_shadows.h"

#include "film/sampling.h"

namespace panoptes::path_tracer {

namespace {

// Bindings of rasterize/shadow_lookup.glsl, and of the lamps' own block in path_tracer/shade.comp.
constexpr GLuint kLightsBinding = 3, kFacesBinding = 4;
constexpr int kMapsUnit = 13;

// Dimensions of the sample sequences, two a lamp; no path has these.
constexpr uint32_t kLampDimension = 0x20000000;

void store(gl::Buffer& buffer, GLuint binding, const void* data, size_t bytes) {
  buffer.reserve(int64_t(bytes));
  if (bytes) buffer.write(0, int64_t(bytes), data);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer.id());
}

}  // namespace

void MapShadows::begin(const std::vector<scene::Light>& lamps, const scene::Bounds& bounds,
                       const glm::dvec3& origin, int resolution) {
  lamps_ = lamps;
  bounds_ = bounds;
  origin_ = origin;
  settings_.resolution = resolution;
  mapped_ = 0;
}

void MapShadows::render(const shared::View& camera, const gpu_scene::GpuScene& scene,
                        gpu_scene::ViewBlock& view_block, gl::ProgramCache& programs,
                        gl::PassTimer& timer) {
  const auto index = uint32_t(camera.size.z), seed = uint32_t(camera.size.w);
  std::vector<rasterize::LightSamplePoint> points;
  for (size_t i = 0; i < lamps_.size(); ++i) {
    const uint32_t dimension = kLampDimension + 2 * uint32_t(i);
    const glm::vec2 u = film::sample_point(index, seed, dimension);
    const glm::vec2 s = film::sample_point(index, seed, dimension + 1);
    points.push_back({u.x, u.y, s - 0.5f});
  }
  const rasterize::LightSet set = rasterize::place_lights(
      lamps_, points, {},
      {.bounds = bounds_,
       .camera_origin = origin_,
       .resolution = settings_.resolution,
       .layers = rasterize::ShadowMaps::layer_limit(settings_, device_)});
  mapped_ = set.batches.empty() ? 0 : set.batches.front().light_count;
  std::vector<shared::Light> lights;
  for (const rasterize::PlacedLight& placed : set.lights) lights.push_back(placed.light);
  if (mapped_ > 0)
    maps_.render(set, set.batches.front(), settings_, camera, scene, programs, timer, view_block,
                 false);
  store(lights_, kLightsBinding, lights.data(), lights.size() * sizeof(shared::Light));
  store(faces_, kFacesBinding, set.faces.data(), set.faces.size() * sizeof(shared::ShadowFace));
}

void MapShadows::bind() const {
  maps_.bind(kMapsUnit);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kLightsBinding, lights_.id());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kFacesBinding, faces_.id());
}

void MapShadows::release() { *this = MapShadows(device_); }

}  // namespace panoptes::path_tracer
