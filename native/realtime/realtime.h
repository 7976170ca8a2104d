// Integrator 1: composes direct light, light that the radiance cache knows of, what occludes it nearby,
// and what rays find for mirrors and glass, into a frame, sample by sample.
#pragma once

#include "ambient_occlusion/occlusion.h"
#include "base/cancelled.h"
#include "film/film.h"
#include "gl/context.h"
#include "gl/pass_timer.h"
#include "gl/program.h"
#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/view.h"
#include "gpu_scene/view_block.h"
#include "plan/effect.h"
#include "radiance_cache/radiance_cache.h"
#include "rasterize/emitter_lights.h"
#include "rasterize/g_buffer.h"
#include "rasterize/shadow_maps.h"
#include "rasterize/sun_cascades.h"
#include "scene/scene.h"
#include "tracing/triangle_list.h"
#include "specular_rays/specular_rays.h"

#include <atomic>
#include <functional>
#include <optional>

namespace panoptes::realtime {

struct Settings {
  rasterize::ShadowSettings shadows;
  ambient_occlusion::Settings occlusion;
  radiance_cache::Settings cache;
  specular_rays::Settings specular_rays;
  uint32_t seed = 0;
  bool transparent_film = false;  // the world behind the scene is not part of Combined
  // One of frames that come one after the other while the scene changes little, as in a 3D View: until
  // its second sample a frame may show some of the light before.
  bool follows = false;
  float filter_width = 1.5f;  // pixels, of the Blackman-Harris window to each side
};

// Programs of this integrator, for the frame and for the shader validation.
struct LightOptions {
  bool shadows = false, filtered_penumbrae = false;
  bool specular_rays = false;  // glowing surfaces are seen by rays
  rasterize::GBufferOptions surfaces;
};
gl::ProgramSource direct_light_program(const LightOptions& options);
struct ComposeOptions {
  bool lamps = false, background = false, world_light = false, transparent_film = false;
  bool occlusion = false, deep_shadows = false, pass_occlusion = false, specular_rays = false;
  std::optional<radiance_cache::LookUpOptions> cache;
  rasterize::GBufferOptions surfaces;
};
gl::ProgramSource compose_program(const ComposeOptions& options, const film::Film& film);
gl::ProgramSource depth_program(const film::Film& film);
gl::ProgramSource background_program(const gpu_scene::GpuShading& world);

// What a frame shows, as the scene is now. Tracer and triangles are null where the plan runs nothing
// that follows rays.
struct Surroundings {
  const gpu_scene::GpuScene& scene;
  const tracing::Tracer* tracer = nullptr;
  const tracing::TriangleList* triangles = nullptr;
};

class Realtime {
 public:
  Realtime(const gl::DeviceInfo& device, gl::ProgramCache& programs, gl::PassTimer& timer)
      : device_(device), programs_(programs), timer_(timer), occlusion_(programs, timer),
        pass_occlusion_(programs, timer), cache_(programs, timer), specular_rays_(programs, timer) {}

  // Prepares for a frame: allocates what the plan runs and releases what it does not. `single` says
  // that the frame has one sample only. `triangles` are those of the scene if the plan runs the radiance
  // cache; null otherwise.
  void begin(const gpu_scene::Camera& camera, const plan::Effects& plan, const Settings& settings,
             bool single, const scene::Scene& scene, const gpu_scene::GpuScene& gpu,
             const tracing::TriangleList* triangles);

  // Adds sample `index` of a frame that begins with sample `first` to the film; `sharing` samples
  // share a pixel's footprint. Throws Cancelled when `cancelled` says so.
  void render_sample(uint32_t index, uint32_t first, uint32_t sharing, const Surroundings& around,
                     film::Film& film, const std::atomic<bool>& cancelled);
  // Rays since begin().
  int64_t rays() const { return specular_rays_.rays(); }

  // Writes into the frame's plan what was only found while it ran.
  void amend(plan::Effects& plan) const { occlusion_.amend(plan); }
  radiance_cache::Occupied cache_occupied() const { return cache_.occupied(); }
  std::string cache_warning() const { return cache_.warning(); }

 private:
  void write_depth(const gpu_scene::GpuScene& gpu, film::Film& film);
  void dispatch_pixels() const;
  // Where sample `index` looks through the pixels, about their centres; what the camera sees there.
  glm::dvec2 sample_jitter(uint32_t index) const;
  shared::View sample_view(uint32_t index, uint32_t sharing) const;
  // What depends on where the picture's first sample, in the G-buffer now, sees something.
  void place_by(const shared::View& view, const gpu_scene::GpuScene& gpu);
  void find_cascades(const std::vector<rasterize::Slab>& slabs, const shared::View& view);
  // The scene's lamps, or others in their stead, and glowing surfaces in a sample.
  rasterize::LightSet place(uint32_t index, const shared::View& view,
                            const gpu_scene::GpuScene& gpu, const std::vector<scene::Light>& lamps,
                            const rasterize::Placement& placement);
  rasterize::Placement placement_of_lamps() const;
  // What only the picture's first sample can tell, where another one is rendered first.
  void look_at_first_sample(uint32_t sharing, const gpu_scene::GpuScene& gpu,
                            const std::atomic<bool>& cancelled);
  // `lasting` maps serve the samples that follow, too.
  void draw_shadow_maps(const rasterize::LightSet& set, const rasterize::LightBatch& batch,
                        const shared::View& view, const gpu_scene::GpuScene& gpu, bool lasting,
                        bool keep);
  ambient_occlusion::AmbientOcclusion::Sample occlusion_sample(uint32_t index,
                                                               const shared::View& view,
                                                               const rasterize::LightSet* lights,
                                                               const gpu_scene::GpuScene& gpu);
  // While the maps of the first batch of `lights` (none: no lamps) are there.
  void find_occlusion(uint32_t index, const shared::View& view, const rasterize::LightSet* lights,
                      const gpu_scene::GpuScene& gpu, const std::atomic<bool>& cancelled);
  // How many points of each lamp light the cache in a picture of so many samples.
  uint32_t cache_points(uint32_t sharing) const;
  // By this point of each lamp, one of so many.
  void light_cache(const rasterize::LightBatch& batch, const shared::View& view, uint32_t points);
  // By the points of the samples that follow the first.
  void light_cache_further(uint32_t points, const shared::View& view, const gpu_scene::GpuScene& gpu,
                           const std::atomic<bool>& cancelled);
  // Once all lamps have lit the cache.
  void gather_cache(const shared::View& view, const gpu_scene::GpuScene& gpu,
                    const std::atomic<bool>& cancelled);
  void begin_occlusion();
  bool undecided() const;
  void choose_views(uint32_t index, const shared::View& view, const rasterize::LightSet* lights,
                    const gpu_scene::GpuScene& gpu);
  void store_lights(const rasterize::LightSet& set);
  // Follows rays from mirrors and glass, before lamps light what they meet.
  void trace_specular(uint32_t index, const shared::View& view, const Surroundings& around,
                      const std::atomic<bool>& cancelled);
  // Whether occlusion is shown in place of the scene.
  bool shows_occlusion() const {
    return settings_.occlusion.picture != ambient_occlusion::Picture::kNone && occlusion_.runs();
  }
  bool shows_cache() const {
    return settings_.cache.picture != radiance_cache::Picture::kNone && cache_.runs();
  }
  void show_cache(const shared::View& view, film::Film& film);
  void show_picture(film::Film& film);
  // Where programs look up the light around, and what they need for it.
  std::optional<radiance_cache::LookUpOptions> look_up() const;
  void bind_ambient(const std::optional<radiance_cache::LookUpOptions>& cache,
                    const gpu_scene::GpuScene& gpu, const shared::View& view);
  void compose(const gpu_scene::GpuScene& gpu, const shared::View& view, film::Film& film);
  // The cache is lit by so many points of each lamp; 0: not in this sample.
  void add_lamps(uint32_t index, const shared::View& view, const gpu_scene::GpuScene& gpu,
                 uint32_t points, const std::atomic<bool>& cancelled);

  gl::DeviceInfo device_;
  gl::ProgramCache& programs_;
  gl::PassTimer& timer_;

  gpu_scene::Camera camera_;
  Settings settings_;
  plan::Effects plan_;
  rasterize::GBufferOptions surfaces_;
  bool lamps_ = false, shadows_ = false, soft_ = false;
  bool alpha_ = false, background_ = false, world_light_ = false, depth_ = false;
  bool deep_shadows_ = false, emissive_light_ = false, single_ = false, filtered_ = false, cascades_ = false;
  std::vector<scene::Light> lights_;
  scene::Bounds bounds_;
  const tracing::TriangleList* triangles_ = nullptr;  // of the frame

  gpu_scene::ViewBlock view_block_;
  rasterize::GBuffer g_buffer_;
  rasterize::EmitterLights emitters_;
  int64_t emitter_revision_ = -1;
  rasterize::ShadowMaps shadow_maps_;
  ambient_occlusion::AmbientOcclusion occlusion_;  // of light
  // Of the AO pass, where that reaches farther than a voxel of the cache.
  ambient_occlusion::AmbientOcclusion pass_occlusion_;
  radiance_cache::WorldLight world_;
  radiance_cache::RadianceCache cache_;
  specular_rays::SpecularRays specular_rays_;
  std::vector<scene::Bounds> sun_cascades_;
  int64_t shadow_revision_ = -1;  // of the scene that the kept maps show
  int shadow_resolution_ = 0;
  gl::Texture diffuse_light_, glossy_light_, environment_;
  gl::Buffer lights_buffer_, faces_buffer_;
};

}  // namespace panoptes::realtime
