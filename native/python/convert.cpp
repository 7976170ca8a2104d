#include "python/convert.h"

#include "base/choices.h"
#include "python/dict.h"
#include "python/technique_settings.h"

namespace panoptes::python {

glm::dmat4 wide_matrix(const py::dict& dict, const char* key) {
  const auto array = need<Array<double>>(dict, key);
  if (array.size() != 16) fail("'{}' must be a 4x4 matrix: please report it", key);
  glm::dmat4 m;
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) m[c][r] = array.data()[r * 4 + c];
  return m;
}

scene::TextureUse texture_use(const py::tuple& tuple) {
  if (tuple.size() != 3) fail("a texture must be (image, interpolation, extension)");
  scene::TextureUse use;
  use.image = tuple[0].cast<scene::Id>();
  use.closest = tuple[1].cast<std::string>() == "CLOSEST";
  const std::string extension = tuple[2].cast<std::string>();
  using Extension = scene::TextureUse::Extension;
  use.extension = extension == "EXTEND" ? Extension::kExtend
                  : extension == "CLIP" ? Extension::kClip
                                        : Extension::kRepeat;
  return use;
}

std::vector<scene::TextureUse> texture_uses(const py::list& list) {
  std::vector<scene::TextureUse> uses;
  for (const auto& item : list) uses.push_back(texture_use(py::tuple(py::reinterpret_borrow<py::object>(item))));
  return uses;
}

glm::mat4 matrix(const Array<float>& row_major, const char* name) {
  if (row_major.size() != 16) fail("'{}' must be a 4x4 matrix: please report it", name);
  glm::mat4 m;
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) m[c][r] = row_major.data()[r * 4 + c];
  return m;
}

std::vector<glm::vec4> params(const Array<float>& array) {
  const auto span = rows<glm::vec4>(array, "params", 4);
  return {span.begin(), span.end()};
}

scene::AlphaMode alpha_mode(const std::string& name) {
  if (name == "PREMUL") return scene::AlphaMode::kPremultiplied;
  if (name == "CHANNEL_PACKED") return scene::AlphaMode::kChannelPacked;
  if (name == "NONE") return scene::AlphaMode::kNone;
  return scene::AlphaMode::kStraight;
}

scene::Light light(const py::dict& dict) {
  scene::Light light;
  const auto type = need<std::string>(dict, "type");
  light.type = type == "SUN"    ? scene::LightType::kSun
               : type == "SPOT" ? scene::LightType::kSpot
               : type == "AREA" ? scene::LightType::kArea
                                : scene::LightType::kPoint;
  light.object_to_world = matrix(need<Array<float>>(dict, "matrix"), "matrix");
  const auto color = need<std::array<float, 3>>(dict, "color");
  light.color = {color[0], color[1], color[2]};
  light.energy = need<float>(dict, "energy");
  light.radius = get(dict, "radius", 0.0f);
  light.angle = get(dict, "angle", 0.0f);
  light.spot_size = get(dict, "spot_size", light.spot_size);
  light.spot_blend = get(dict, "spot_blend", 0.0f);
  const auto shape = get<std::string>(dict, "shape", "SQUARE");
  light.shape = shape == "RECTANGLE" ? scene::AreaShape::kRectangle
                : shape == "DISK"    ? scene::AreaShape::kDisk
                : shape == "ELLIPSE" ? scene::AreaShape::kEllipse
                                     : scene::AreaShape::kSquare;
  light.size_x = get(dict, "size", 1.0f);
  light.size_y = get(dict, "size_y", light.size_x);
  light.spread = get(dict, "spread", light.spread);
  light.cast_shadow = get(dict, "cast_shadow", true);
  return light;
}

namespace {

gpu_scene::Lens lens(const py::dict& dict) {
  gpu_scene::Lens lens;
  lens.radius = get(dict, "radius", lens.radius);
  lens.focus_distance = get(dict, "focus_distance", lens.focus_distance);
  lens.blades = get(dict, "blades", lens.blades);
  lens.rotation = get(dict, "rotation", lens.rotation);
  lens.ratio = get(dict, "ratio", lens.ratio);
  return lens;
}

path_tracer::Settings path_settings(const py::dict& dict) {
  path_tracer::Settings s;
  s.bounces.total = get(dict, "bounces", s.bounces.total);
  s.bounces.diffuse = get(dict, "diffuse_bounces", s.bounces.diffuse);
  s.bounces.glossy = get(dict, "glossy_bounces", s.bounces.glossy);
  s.bounces.transmission = get(dict, "transmission_bounces", s.bounces.transmission);
  s.bounces.transparent = get(dict, "transparent_bounces", s.bounces.transparent);
  s.clamp_direct = get(dict, "clamp_direct", s.clamp_direct);
  s.clamp_indirect = get(dict, "clamp_indirect", s.clamp_indirect);
  s.filter_glossy = get(dict, "filter_glossy", s.filter_glossy);
  s.shadow_maps = get(dict, "shadow_maps", s.shadow_maps);
  s.raster_primary = get(dict, "raster_primary", s.raster_primary);
  s.ao_distance = get(dict, "ao_distance", s.ao_distance);
  return s;
}

// float32 (height, width, 4); empty where there is none.
std::vector<float> picture(const py::dict& dict, const char* key) {
  const auto pixels = get<Array<float>>(dict, key, {});
  return {pixels.data(), pixels.data() + pixels.size()};
}

}  // namespace

engine::TakeOver take_over(const py::dict& dict) {
  return {picture(dict, "smooth"), picture(dict, "before"), uint32_t(get<int64_t>(dict, "before_samples", 0))};
}

engine::RenderRequest request(const py::dict& dict) {
  engine::RenderRequest r;
  r.camera.width = need<int>(dict, "width");
  r.camera.height = need<int>(dict, "height");
  r.camera.world_to_camera = wide_matrix(dict, "view");
  r.camera.projection = wide_matrix(dict, "projection");
  const auto samples = need<std::array<int64_t, 2>>(dict, "samples");
  if (samples[0] < 0 || samples[1] <= samples[0] || samples[1] > 0x7fffffff)
    fail("samples {} to {} are an empty range: ask for at least one sample", samples[0],
         samples[1]);
  r.first_sample = uint32_t(samples[0]);
  r.last_sample = uint32_t(samples[1]);
  r.seed = uint32_t(get<int64_t>(dict, "seed", 0));
  for (const auto& name : get<std::vector<std::string>>(dict, "passes", {"Combined"})) {
    const film::Pass pass = film::find_pass(name);
    if (pass == film::Pass::kCount)
      fail("there is no pass '{}': see the README for those that there are", name);
    r.passes.set(size_t(pass));
  }
  const auto shown = get<std::string>(dict, "shown_pass", "Combined");
  r.shown_pass = film::find_pass(shown);
  if (r.shown_pass == film::Pass::kCount)
    fail("there is no pass '{}' to be shown: see the README for those that there are", shown);
  const auto method = get<std::string>(dict, "method", "realtime");
  r.method = find_choice<engine::Method>(engine::kMethodNames, method);
  if (!known_choice(engine::kMethodNames, r.method))
    fail("there is no method '{}': choose one of {}", method, fmt::join(engine::kMethodNames, ", "));
  r.camera.lens = lens(get(dict, "lens", py::dict()));
  r.filter_width = get(dict, "filter_width", r.filter_width);
  r.exposure = get(dict, "exposure", r.exposure);
  r.force_all_effects = get(dict, "force_all_effects", false);
  r.live = get(dict, "live", false);
  r.viewport = get(dict, "viewport", false);
  r.pieces = get(dict, "pieces", false);
  const py::dict settings = get(dict, "settings", py::dict());
  static const std::set<std::string> known{
      "shadow_resolution",    "soft_shadows",        "filter_penumbrae", "time_budget",
      "noise_threshold",      "film_transparent",    "debug_picture",    "structure",
      "tiles",                "buckets",             "bounces",          "diffuse_bounces",
      "glossy_bounces",       "transmission_bounces", "transparent_bounces", "clamp_direct",
      "clamp_indirect",       "filter_glossy",       "shadow_maps",      "raster_primary",
      "ao_distance",          "occlusion",           "cache",            "specular_rays",
      "denoise",              "fragments"};
  for (const auto& item : settings)
    if (!known.count(item.first.cast<std::string>()))
      fail("there is no setting '{}': please report it", item.first.cast<std::string>());
  r.shadow_resolution = get(settings, "shadow_resolution", r.shadow_resolution);
  r.soft_shadows = get(settings, "soft_shadows", r.soft_shadows);
  r.filter_penumbrae = get(settings, "filter_penumbrae", r.filter_penumbrae);
  r.transparent_film = get(settings, "film_transparent", false);
  r.time_budget = get(settings, "time_budget", 0.0);
  r.noise_threshold = get(settings, "noise_threshold", 0.0);
  const auto debug_picture = get<std::string>(settings, "debug_picture", "none");
  r.debug_picture = ray_picture::find_kind(debug_picture);
  if (!ray_picture::known(r.debug_picture))
    fail("there is no debug picture '{}': choose one of {}", debug_picture,
         fmt::join(ray_picture::kKindNames, ", "));
  const auto structure = get<std::string>(settings, "structure", "auto");
  r.structure.structure = engine::find_structure(structure);
  if (r.structure.structure == engine::Structure(-1))
    fail("there is no structure '{}' for rays: choose one of {}", structure,
         fmt::join(engine::kStructureNames, ", "));
  r.structure.tiles = get(settings, "tiles", 0);
  r.structure.buckets = get(settings, "buckets", 0);
  r.structure.fragments = fragment_settings(get(settings, "fragments", py::dict()));
  r.paths = path_settings(settings);
  const auto denoiser = get<std::string>(settings, "denoise", "off");
  r.denoise.denoiser = find_choice<denoise::Denoiser>(denoise::kDenoiserNames, denoiser);
  if (!known_choice(denoise::kDenoiserNames, r.denoise.denoiser))
    fail("there is no denoiser '{}': choose one of {}", denoiser, fmt::join(denoise::kDenoiserNames, ", "));
  r.occlusion = occlusion_settings(get(settings, "occlusion", py::dict()));
  r.cache = cache_settings(get(settings, "cache", py::dict()));
  r.specular_rays = specular_settings(get(settings, "specular_rays", py::dict()));
  return r;
}

}  // namespace panoptes::python
