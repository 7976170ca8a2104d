// What a caller asks of a frame, and what it is told of it.
#pragma once

#include "ambient_occlusion/settings.h"
#include "denoise/settings.h"
#include "engine/structure.h"
#include "film/passes.h"
#include "gpu_scene/view.h"
#include "path_tracer/settings.h"
#include "plan/effect.h"
#include "radiance_cache/settings.h"
#include "ray_picture/kind.h"
#include "specular_rays/settings.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace panoptes::engine {

enum class Method {
  kRealtime,   // shadow maps and rasterised light
  kPrimitive,  // path tracing over exact intersections
  kFragment,   // path tracing over layers of pixels (Structure::kFragments)
};

constexpr std::array<std::string_view, 3> kMethodNames{"realtime", "primitive", "fragment"};

struct RenderRequest {
  gpu_scene::Camera camera;
  Method method = Method::kRealtime;
  uint32_t first_sample = 0, last_sample = 1;  // half-open
  uint32_t seed = 0;
  film::PassSet passes;
  // In a 3D View: what read(Combined) gives in its place, as a picture to look at (film/display.h). One of
  // `passes`; only what it needs runs.
  film::Pass shown_pass = film::Pass::kCombined;
  float filter_width = 1.5f;    // pixels, to each side
  float exposure = 1.0f;        // multiplies light passes
  bool force_all_effects = false;
  bool live = false;            // Combined can be read while the frame renders
  bool viewport = false;        // one of frames that follow each other: its light may keep a share of
                                // the last one's
  // Keeps what merges with other ranges of samples. Each sample then looks the same in every range.
  bool pieces = false;
  int shadow_resolution = 2048; // texels a side, 16 .. 8192
  bool soft_shadows = true;
  bool filter_penumbrae = false;  // by blocker distance, instead of a point of each lamp a sample
  bool transparent_film = false;  // Combined's alpha is 0 where the world is seen
  double time_budget = 0;       // s; 0: none. At least one sample is rendered.
  double noise_threshold = 0;   // relative; 0: none
  // Shows rays at work in place of the scene, in Combined; other passes stay 0.
  ray_picture::Kind debug_picture = ray_picture::Kind::kNone;
  StructureSettings structure;  // for rays
  path_tracer::Settings paths;
  // Of Combined by paths: at the end, and in a 3D View whenever it is shown.
  denoise::Settings denoise;
  ambient_occlusion::Settings occlusion;  // these three: of Real-time
  radiance_cache::Settings cache;
  specular_rays::Settings specular_rays;

  // Throws Error with a sentence when a value is out of range.
  void check() const;
};

// Where paths take over a picture of Real-time's in a 3D View (film/mixture.h): that picture, and the mean of the
// samples of paths that an earlier job has made. RGBA, rows bottom to top, of the request's size; empty: none.
struct TakeOver {
  std::vector<float> smooth, before;
  uint32_t before_samples = 0;

  // Throws Error with a sentence where the sizes are others.
  void check(const gpu_scene::Camera& camera) const;
};

struct EffectReport : plan::Effect {
  double ms = 0;  // of the passes that run for it alone
};

struct RenderStats {
  std::string device;
  int width = 0, height = 0;
  uint32_t samples = 0;  // rendered
  std::vector<EffectReport> effects;
  std::vector<std::pair<std::string, double>> passes;  // name, ms
  double build_ms = 0, trace_ms = 0, total_ms = 0;
  int64_t rays = 0;
  radiance_cache::Occupied cache;
  int64_t memory_bytes = 0;
  std::optional<double> estimated_error;
  std::vector<std::string> warnings;

  std::string to_json() const;
};

}  // namespace panoptes::engine
