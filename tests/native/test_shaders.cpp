// Every permutation that native code can ask for: valid to the reference compiler, and accepted by
// the driver at hand.
#include "base/error.h"
#include "denoise/edge_avoiding.h"
#include "film/film.h"
#include "gl/context.h"
#include "gl/program.h"
#include "path_tracer/programs.h"
#include "path_tracer/raster_primary.h"
#include "path_tracer/world_map.h"
#include "fragment_tracer/fragment_tracer.h"
#include "primitive_tracer/cube_tracer.h"
#include "primitive_tracer/orthographic_tracer.h"
#include "radiance_cache/geometry_volume.h"
#include "radiance_cache/reflective_maps.h"
#include "rasterize/emitter_lights.h"
#include "rasterize/g_buffer.h"
#include "rasterize/sun_cascades.h"
#include "ray_picture/ray_picture.h"
#include "rays/tracers.h"
#include "realtime/realtime.h"
#include "specular_rays/programs.h"
#include "support.h"
#include "tracing/opacity.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace panoptes::test {
namespace {

namespace fs = std::filesystem;

// Each of the four switches by a bit of its own.
rasterize::GBufferOptions surfaces(int bits) {
  return {.glossy = bool(bits & 1),
          .emission = bool(bits & 2),
          .transmission = bool(bits & 4),
          .layers = bool(bits & 8)};
}

// Calls everything that generated code may call.
constexpr const char* kEverything =
    "void evaluate_material(const Hit hit, inout Surface surface) {\n"
    "  vec2 uv = hit_uv(hit, UV_DEFAULT) + hit_uv(hit, ATTRIBUTE(0));\n"
    "  vec4 color = hit_color(hit, COLOR_DEFAULT) + hit_color(hit, ATTRIBUTE(1));\n"
    "  vec3 place = hit_world_position(hit) + hit_object_position(hit) + hit_generated(hit);\n"
    "  vec3 normal = normal_map_tangent(hit, ATTRIBUTE(0), color.rgb, param(1).x);\n"
    "  normal = normalize(normal + normal_map_object(hit, color.rgb, 0.5) +\n"
    "                     normal_map_world(hit, color.rgb, 0.5));\n"
    "#if IMAGE_COUNT > 0\n"
    "  color += sample_image(hit, 0, uv, false) + sample_image(hit, 1, uv, true);\n"
    "  color += sample_image_cubic(1, uv, 0.1, true);\n"
    "#endif\n"
    "  if (hit.backfacing) color.rgb *= hit.view * hit.geometric_normal * hit.position;\n"
    "  closure_diffuse(surface, vec3(0.1), color.rgb, 0.5, normal);\n"
    "  closure_glossy(surface, vec3(0.1), color.rgb, 0.3, normal);\n"
    "  closure_glass(hit, surface, vec3(0.1), color.rgb, 0.1, 1.5, normal);\n"
    "  closure_refraction(hit, surface, vec3(0.1), color.rgb, 0.1, 1.5, hit.normal);\n"
    "  closure_glossy_multiscatter(hit, surface, vec3(0.1), color.rgb, 0.3, normal);\n"
    "  closure_glass_multiscatter(hit, surface, vec3(0.1), color.rgb, 0.3, 1.5, normal);\n"
    "  closure_transparent(surface, vec3(0.1), place);\n"
    "  closure_emission(surface, vec3(0.1), place);\n"
    "  Principled p = principled_defaults(hit);\n"
    "  p.metallic = p.subsurface = p.transmission = p.alpha = param(0).x;\n"
    "  p.coat = p.sheen = 0.5;\n"
    "  p.multiscatter = true;\n"
    "  closure_principled_v3(surface, vec3(0.2), p);\n"
    "  closure_principled_v4(surface, vec3(0.2), p);\n"
    "}\n";

constexpr const char* kPlainWorld =
    "vec3 evaluate_world(vec3 direction) { return param(0).rgb; }\n";
constexpr const char* kImageWorld =
    "vec3 evaluate_world(vec3 direction) {\n"
    "  return sample_image_wide(0, direction.xy, 0.0, false).rgb * luminance(param(0).rgb) +\n"
    "         sample_image_cubic(0, direction.xy, 0.0, true).rgb;\n"
    "}\n";

class Shaders : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    context = std::make_unique<gl::Context>();
    enumerate();
  }
  static void TearDownTestSuite() {
    sources.clear();
    context.reset();
  }

  static gpu_scene::GpuMaterial material(const char* code, int images, bool alpha) {
    gpu_scene::GpuMaterial m;
    m.name = "test";
    m.code = code;
    m.textures.resize(size_t(images));
    m.facts.alpha = alpha;
    return m;
  }

  static void add(gl::ProgramSource source) {
    std::string key = source.key();
    sources.emplace(std::move(key), std::move(source));
  }

  // What path_tracer::Lights says of lights of the kind-th kind, or (5) of all; `many`: of several, with
  // the world among them.
  static std::vector<std::string> light_defines(int kind, bool many, bool seen) {
    std::vector<std::string> defines;
    const char* kinds[5] = {"LIGHT_SUNS", "LIGHT_POINTS", "LIGHT_SPOTS", "LIGHT_AREAS", "LIGHT_TRIANGLES"};
    for (int k = 0; k < 5; ++k)
      defines.push_back(fmt::format("{} {}", kinds[k], int(kind == k || kind == 5)));
    defines.push_back("LIGHT_ANY 1");
    defines.push_back(fmt::format("LIGHT_LOCAL {}", int(kind != 0)));
    defines.push_back(fmt::format("LIGHT_TREE {}", int(many || kind == 5)));
    defines.push_back(fmt::format("LAMPS_SEEN {}", int(seen)));
    defines.push_back(fmt::format("WORLD_SAMPLED {}", int(many)));
    return defines;
  }

  // All that paths may ask of them.
  static gl::ProgramSource lights_program(int kind, bool many, bool seen) {
    gl::ProgramSource source;
    source.name = "lights";
    source.stages = {{GL_COMPUTE_SHADER, "lights.comp"}};
    source.snippets["lights.comp"] =
        "#include \"path_tracer/lights.glsl\"\n"
        "layout(local_size_x = 64) in;\n"
        "layout(std430, binding = 0) buffer Results { vec4 results[]; };\n"
        "void main() {\n"
        "  vec3 from = results[0].xyz, normal = results[1].xyz, way = results[2].xyz;\n"
        "  LightSample s;\n"
        "  if (light_sample(from, normal, way, s)) results[3] = vec4(s.value, s.pdf);\n"
        "  results[4] = vec4(lamps_seen(from, normal, way, FAR, 0.5),\n"
        "                    light_pdf_primitive(from, normal, 1u, way, 2.0) +\n"
        "                        light_pdf_world(from, normal, way));\n"
        "}\n";
    source.defines = light_defines(kind, many, seen);
    return source;
  }

  // Each program of paths that materials and worlds are no part of, for one set of options.
  static void add_paths(const path_tracer::ProgramOptions& options, const film::Film& film) {
    for (bool listed : {false, true}) {
      for (bool centre : {false, true})
        add(path_tracer::begin_paths_program(options, listed, centre));
      add(path_tracer::resolve_program(options, listed, film));
      add(path_tracer::arrive_program(options, listed));
    }
    add(path_tracer::shade_program(options));
    add(path_tracer::miss_program(nullptr, options));
    add(path_tracer::depth_program(film));
    add(path_tracer::occlusion_rays_program(options));
    if (options.occlusion) add(path_tracer::occlusion_program(options));
  }

  static path_tracer::ProgramOptions path_options(int bits, bool rich) {
    path_tracer::ProgramOptions options;
    options.surfaces = surfaces(bits);
    options.add_passes(rich ? film::PassSet().set() : film::with_divisors({}));
    if (rich) options.light_defines = light_defines(5, true, true);
    options.clamp = options.filter_glossy = options.lens = options.alpha = rich;
    options.shines = options.deferred = options.shadow_maps = rich;
    return options;
  }

  static void add_occlusion(film::Film& film) {
    using ambient_occlusion::ViewKind;
    // A camera and a phantom view have one face; a lamp's map has one, six or cascades.
    const std::vector<ambient_occlusion::SampleOptions> views{
        {.view = ViewKind::kCamera},
        {.view = ViewKind::kPhantom},
        {.view = ViewKind::kLamp},
        {.view = ViewKind::kLamp, .cube = true},
        {.view = ViewKind::kLamp, .cascades = true}};
    for (ambient_occlusion::SampleOptions options : views)
      for (int estimator = 0; estimator < 4; ++estimator)
        for (int bits = 0; bits < 8; ++bits) {
          options.obscurance = estimator == 3;
          options.estimator = ambient_occlusion::Estimator(estimator % 3);
          options.importance_sampling = bits & 1;
          options.bent_normals = bits & 2;
          options.probes = bits & 4;
          const bool fixed = options.obscurance ||
                             options.estimator == ambient_occlusion::Estimator::kHbao;
          if (options.importance_sampling && (fixed || options.probes)) continue;
          if (options.bent_normals && (options.obscurance || options.probes)) continue;
          add(ambient_occlusion::sample_program(options));
        }
    for (bool bent : {false, true}) add(ambient_occlusion::combine_program(bent));
    add(ambient_occlusion::filter_program());
    film.start(4, 4, {});
    for (int picture = 1; picture < int(ambient_occlusion::kPictureNames.size()); ++picture)
      add(ambient_occlusion::picture_program(ambient_occlusion::Picture(picture), film));
  }

  // But for those that materials and worlds are part of.
  static void add_specular_rays() {
    add(specular_rays::begin_program());
    for (int bits = 0; bits < 32; ++bits) {
      const specular_rays::ProgramOptions options{surfaces(bits), bool(bits & 16), bool(bits & 16)};
      add(specular_rays::select_program(options));
      add(specular_rays::go_on_program(options));
      for (bool world : {false, true}) add(specular_rays::surroundings_program(options, {world, {}}));
      for (bool filtered : {false, true})
        add(specular_rays::lamps_program(options, {bool(bits & 16), filtered}));
    }
  }

  static void enumerate() {
    const char* plain = "void evaluate_material(const Hit hit, inout Surface surface) {\n"
                        "  closure_principled_v3(surface, vec3(1.0), principled_defaults(hit));\n"
                        "}\n";
    for (bool depth_only : {false, true})
      add(rasterize::raster_program(nullptr, {.depth_only = depth_only}));
    for (bool alpha : {false, true})
      for (const auto& m :
           {material(plain, 0, alpha), material(kLambert, 0, alpha),
            material(kEverything, 0, alpha), material(kEverything, 2, alpha),
            material(kEverything, context->device().max_texture_units - 8, alpha)}) {
        if (alpha)
          for (bool depth_only : {false, true})
            add(rasterize::raster_program(&m, {.depth_only = depth_only}));
        for (int bits = 0; bits < 16; ++bits) add(rasterize::surface_program(m, surfaces(bits)));
        add(rasterize::emitter_program(m));
        add(radiance_cache::surfels_program(m));
        add(radiance_cache::rsm_surfaces_program(m));
        // What a material is makes no difference to how its lobes are stored: one is tried with all.
        for (int bits = 0; bits < 16; ++bits)
          if (bits == 0 || bits == 15 || m.textures.size() == 2)
            add(path_tracer::fetch_program(m, path_options(bits, false)));
        for (int bits : {0, 15}) add(specular_rays::fetch_program(m, {surfaces(bits), alpha}));
        for (bool rich : {false, true})
          add(path_tracer::arrive_emitter_program(m, path_options(0, rich)));
        for (tracing::OpacityOptions opacity : {tracing::OpacityOptions{false, false},
                                                tracing::OpacityOptions{false, true},
                                                tracing::OpacityOptions{true, true}})
          add(tracing::opacity_program(m, opacity));
      }
    for (const char* name : {"bin_count", "bin_offsets", "bin_scatter"})
      add(rasterize::bin_program(name));
    for (bool shadows : {false, true})
      for (int bits = 0; bits < 16; ++bits)
        for (bool filtered : {false, true})
          for (bool rays : {false, true})
            add(realtime::direct_light_program({shadows, filtered, rays, surfaces(bits)}));
    add(rasterize::visible_bounds_program());

    // Passes only add stores; each alone, none and all stand for the rest.
    film::Film film;
    const auto with_film = [&](const film::PassSet& passes, bool moments, int bits,
                               bool occlusion = false, bool deep_shadows = false,
                               std::optional<radiance_cache::LookUpOptions> cache = {}) {
      film.start(4, 4, passes, {.moments = moments});
      add(realtime::compose_program({.lamps = bool(bits & 16),
                                     .background = bool(bits & 32),
                                     .world_light = bool(bits & 64),
                                     .transparent_film = bool(bits & 128),
                                     .occlusion = occlusion,
                                     .deep_shadows = deep_shadows,
                                     .pass_occlusion = deep_shadows && cache,
                                     .specular_rays = deep_shadows,
                                     .cache = cache,
                                     .surfaces = surfaces(bits)},
                                    film));
    };
    film.start(4, 4, {}, {});
    for (int encoding = 0; encoding < 6; ++encoding)
      for (bool split : {false, true}) {
        const radiance_cache::LookUpOptions cache{.encoding = radiance_cache::Encoding(encoding),
                                                  .split = split,
                                                  .scaled = split && encoding % 2 == 0,
                                                  .unit = 16,
                                                  .block = 2};
        // Encodings only meet in how cells are read: one program of each kind stands for the others.
        for (int picture = 1; picture < 6 && encoding % 3 == 0 && !split; ++picture)
          add(radiance_cache::picture_program(radiance_cache::Picture(picture), cache, film));
        for (int bits : {15, 80})
          if (bits == 15 || encoding % 3 == 0)
            with_film(film::PassSet().set(), true, bits, split, split, cache);
        add(radiance_cache::bounce_program(cache, split, true, true));
        add(radiance_cache::blend_program(cache.encoding, split));
        add(specular_rays::surroundings_program({surfaces(15), false}, {split, cache}));
        for (bool world : {false, true})
          for (bool bounced : {false, true})
            for (bool reflected : {false, true})
              add(radiance_cache::gather_program({cache.encoding, split, world, bounced, reflected}));
      }
    for (bool met_alone : {false, true}) {
      add(radiance_cache::bounce_program({}, true, false, met_alone));
      add(radiance_cache::bounce_program({.walls = false}, true, true, met_alone));
      for (bool shadows : {false, true}) add(radiance_cache::light_surfels_program(shadows, met_alone));
    }
    add(radiance_cache::find_seeds_program());
    add(radiance_cache::find_reach_program());
    for (bool either : {false, true}) {
      for (auto occupancy : {radiance_cache::Occupancy::kGeometry, radiance_cache::Occupancy::kDepth,
                             radiance_cache::Occupancy::kTiers, radiance_cache::Occupancy::kAll})
        add(radiance_cache::list_cells_program(occupancy, either));
      for (bool mark_met : {false, true}) add(radiance_cache::march_program(either ? 12 : 0, either, mark_met));
      for (bool mixed : {false, true})
        add(radiance_cache::rsm_gather_program(mixed, either ? 12 : 0, either));
    }
    for (int bits = 0; bits < 256; ++bits) {
      with_film(film::PassSet().set(), true, bits);
      // Without passes surfaces of one kind stand for the others.
      if (bits % 16 == 0 || bits % 16 == 15) with_film({}, false, bits);
    }
    // Occlusion only meets the world's light, of all kinds of surfaces or of none.
    for (int bits : {0, 64, 79, 255})
      for (bool deep_shadows : {false, true}) {
        with_film(film::PassSet().set(), true, bits, true, deep_shadows);
        with_film({}, false, bits, true, deep_shadows);
      }
    add_occlusion(film);
    add_specular_rays();
    for (int pass = 0; pass < film::kPassCount; ++pass)
      for (int bits : {0, 255}) with_film(film::PassSet().set(size_t(pass)), false, bits);

    for (bool moments : {false, true}) {
      film.start(4, 4, film::PassSet().set(size_t(film::Pass::kDepth)), {.moments = moments});
      add(realtime::depth_program(film));
    }

    for (const gl::ProgramSource& source : primitive_tracer::orthographic_build_programs())
      add(source);
    for (int kind = 1; kind < int(ray_picture::kKindNames.size()); ++kind)
      for (bool moments : {false, true}) {
        film.start(4, 4, {}, {.moments = moments});
        add(ray_picture::false_colour_program(ray_picture::Kind(kind), film));
      }
    add(ray_picture::camera_rays_program());
    for (bool smooths : {false, true})
      for (bool positions : {false, true}) add(denoise::filter_program(smooths, positions));
    add(tracing::flatten_program());
    add(radiance_cache::mark_seen_program());
    for (gl::ProgramSource& source : radiance_cache::volume_programs()) add(std::move(source));
    for (int bits = 0; bits < 4; ++bits) {
      add(tracing::open_rays_program(bits & 1, bits & 2));
      for (bool alpha_only : {false, true})
        add(tracing::hits_by_material_program(bits & 1, bits & 2, alpha_only));
    }
    for (const TracerEntry& entry : tracers()) {
      const auto tracer = entry.make(context->device());
      for (int bits = 0; bits < 4; ++bits)
        for (auto surfaces : {tracing::Surfaces::kAll, tracing::Surfaces::kOpaque,
                              tracing::Surfaces::kAlpha})
          for (auto from : {tracing::RaySource::kAll, tracing::RaySource::kListed,
                            tracing::RaySource::kResumed})
            add(tracing::trace_program(*tracer, {bool(bits & 1), bool(bits & 2), surfaces}, from));
    }
    for (int bits = 0; bits < 6; ++bits) {
      primitive_tracer::CubeSettings settings{.linked_lists = bits % 3 > 0,
                                              .thesis_rejection = bits % 3 > 1};
      if (bits >= 3) settings.single_view = primitive_tracer::SingleView{};
      for (gl::ProgramSource& source : primitive_tracer::cube_build_programs(settings))
        add(std::move(source));
      const primitive_tracer::CubeTracer tracer(settings);
      for (bool any_hit : {false, true})
        for (auto from : {tracing::RaySource::kAll, tracing::RaySource::kResumed})
          add(tracing::trace_program(tracer, {.any_hit = any_hit, .count_work = any_hit}, from));
    }

    for (int bits = 0; bits < 5 * 12; ++bits) {
      fragment_tracer::Settings settings;
      settings.storage = fragment_tracer::Storage(bits % 5);
      settings.walk = fragment_tracer::Walk(bits / 5 % 3);
      settings.decoupled = settings.by_plane = bits / 15 % 2;
      settings.skipping = settings.binary_search = bits / 30 % 2;
      settings.bounds = fragment_tracer::Bounds(bits / 15 % 2);
      if (!has_buckets(settings.storage)) settings.layers = bits / 15 % 2 * 4;
      const bool camera = bits % 2;
      for (gl::ProgramSource& source : fragment_tracer::build_programs(settings, camera ? 7 : 6, camera))
        add(std::move(source));
      const fragment_tracer::FragmentTracer tracer(settings, glm::vec3(0), fragment_tracer::CameraView{});
      for (bool any_hit : {false, true})
        for (auto from : {tracing::RaySource::kAll, tracing::RaySource::kResumed})
          add(tracing::trace_program(tracer, {.any_hit = any_hit, .count_work = any_hit}, from));
    }

    for (bool rich : {false, true}) {
      film.start(4, 4, rich ? film::PassSet().set() : film::PassSet(), {.moments = rich});
      for (int bits = 0; bits < 16; ++bits) add_paths(path_options(bits, rich), film);
    }
    add(path_tracer::visible_hits_program());

    for (int kind = 0; kind < 6; ++kind)
      for (int bits = 0; bits < 4; ++bits) add(lights_program(kind, bits & 1, bits & 2));

    for (const auto& [code, images] : {std::pair(kPlainWorld, 0), {kImageWorld, 1}}) {
      gpu_scene::GpuShading world;
      world.code = code;
      world.textures.resize(size_t(images));
      add(realtime::background_program(world));
      add(radiance_cache::world_radiance_program(world));
      add(path_tracer::world_map_program(world));
      for (bool alpha : {false, true}) add(specular_rays::miss_program(world, {surfaces(0), alpha}));
      for (bool rich : {false, true}) {
        add(path_tracer::miss_program(&world, path_options(0, rich)));
        add(path_tracer::arrive_world_program(world, path_options(0, rich)));
      }
    }
  }

  static inline std::unique_ptr<gl::Context> context;
  static inline std::map<std::string, gl::ProgramSource> sources;  // by key: no doubles
};

std::string describe(const gl::ProgramSource& source) {
  std::string text = source.name + ":";
  for (const std::string& define : source.defines) text += " " + define + ";";
  return text;
}

TEST_F(Shaders, TheDriverAcceptsEveryPermutation) {
  EXPECT_GT(sources.size(), 150u);
  for (const auto& [key, source] : sources)
    EXPECT_NO_THROW(gl::Program{source}) << describe(source);
  EXPECT_NO_THROW(gl::check_errors("compiling"));
}

TEST_F(Shaders, TheReferenceCompilerAcceptsEveryPermutation) {
  if (std::system("glslangValidator --version >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "glslangValidator is not installed (Debian: glslang-tools)";
  const fs::path folder = fs::temp_directory_path() / fmt::format("panoptes_shaders_{}", getpid());
  fs::create_directories(folder);
  std::ofstream list(folder / "list");
  std::map<std::string, std::string> labels;
  std::map<std::string, std::vector<std::string>> files;  // that a text's #line numbers mean
  int number = 0;
  for (const auto& [key, source] : sources)
    for (const gl::Stage& stage : source.stages) {
      const std::string name =
          fmt::format("{}{}", ++number, fs::path(stage.file).extension().string());
      const gl::ExpandedSource expanded = gl::expand(source, stage);
      std::ofstream(folder / name) << expanded.text;
      files[name] = expanded.files;
      labels[name] = describe(source);
      list << name << '\n';
    }
  list.close();
  const std::string command =
      fmt::format("cd '{}' && xargs -a list -n 40 glslangValidator > log 2>&1", folder.string());
  if (std::system(command.c_str()) != 0) {
    // The first message of each program that has one; a mistake in a shared file shows in many.
    std::ifstream log(folder / "log");
    std::map<std::string, int> messages;
    std::string line, program;
    while (std::getline(log, line)) {
      if (labels.count(line)) program = line;
      if (line.find("ERROR: ") != 0 || program.empty()) continue;
      const std::string message = gl::translate_log(line, files[program]);
      if (++messages[message] == 1) ADD_FAILURE() << labels[program] << "\n" << message;
      program.clear();
    }
    EXPECT_FALSE(messages.empty()) << "glslangValidator failed without a word";
  }
  fs::remove_all(folder);
}

}  // namespace
}  // namespace panoptes::test
