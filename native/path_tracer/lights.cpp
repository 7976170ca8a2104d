#include "path_tracer/lights.h"

#include "base/error.h"
#include "path_tracer/glowing_triangles.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

namespace panoptes::path_tracer {

namespace {

// Lamps that scattered rays look for: llvmpipe cuts an invocation off after 65 535 iterations, and in
// the worst case a ray goes through all the nodes of a tree of lamps, two a lamp, and all the suns.
constexpr size_t kMostSeenLamps = 16384, kMostSeenSuns = 1024;

// Suns with an extent, then other suns, then other lamps.
int rank(const DescribedLight& light) {
  if (light.kind() != shared::KIND_SUN) return 2;
  return light.seen ? 0 : 1;
}

}  // namespace

void Lights::update(const scene::Scene& scene, const gpu_scene::GpuScene& gpu,
                    const tracing::TriangleList& triangles, gl::ProgramCache& programs,
                    gl::PassTimer& timer) {
  const bool shapes = geometry_revision_ != gpu.geometry_revision();
  const bool glow = shapes || emission_revision_ != gpu.emission_revision();
  const bool lamps = glow || lamp_revision_ != gpu.shadow_revision();
  const bool world = world_revision_ != gpu.world_revision();
  if (!lamps && !world) return;
  gl::PassScope scope(timer, "lights");
  geometry_revision_ = emission_revision_ = lamp_revision_ = world_revision_ = -1;  // until all is well
  if (glow) triangles_ = glowing_triangles(scene, gpu, triangles.origin(), programs, view_block_);
  if (lamps) list(scene, triangles.origin());
  if (world) {
    world_.clear();
    if (gpu.world() && !scene.world().constant) world_.update(gpu, device_, programs);
    constants_.world_width = uint32_t(world_.size().x);
    constants_.world_height = uint32_t(world_.size().y);
    constants_.world_irradiance = world_.irradiance();
  }
  constant_block_.reserve(sizeof constants_);
  constant_block_.write(0, sizeof constants_, &constants_);
  geometry_revision_ = gpu.geometry_revision();
  emission_revision_ = gpu.emission_revision();
  lamp_revision_ = gpu.shadow_revision();
  world_revision_ = gpu.world_revision();
}

void Lights::list(const scene::Scene& scene, const glm::vec3& origin) {
  std::vector<DescribedLight> lights;
  for (size_t i = 0; i < scene.lights().size(); ++i)
    if (auto light = describe(scene.lights()[i], glm::dvec3(origin))) {
      light->record.edge_y.w = std::bit_cast<float>(uint32_t(i));
      lights.push_back(std::move(*light));
    }
  std::stable_sort(lights.begin(), lights.end(),
                   [](const DescribedLight& a, const DescribedLight& b) { return rank(a) < rank(b); });
  lights.insert(lights.end(), triangles_.begin(), triangles_.end());
  upload(std::move(lights));
}

void Lights::upload(std::vector<DescribedLight> lights) {
  using namespace shared;
  count_ = uint32_t(lights.size());
  kinds_ = {};
  warnings_.clear();
  std::vector<LightBounds> bounds, seen_bounds;
  std::vector<uint32_t> seen;  // records of lamps that are somewhere
  size_t seen_suns = 0;
  for (uint32_t i = 0; i < count_; ++i) {
    const DescribedLight& light = lights[i];
    const uint32_t kind = light.kind();
    kinds_.suns |= kind == KIND_SUN;
    kinds_.points |= kind == KIND_POINT;
    kinds_.spots |= kind == KIND_SPOT;
    kinds_.areas |= kind == KIND_RECTANGLE || kind == KIND_ELLIPSE;
    kinds_.triangles |= kind == KIND_TRIANGLE;
    kinds_.varying |= bool(light.flags() & RECORD_VARIES);
    kinds_.seen |= light.seen;
    bounds.push_back(light.bounds);
    if (!light.seen) continue;
    if (light.bounds.infinite) {
      ++seen_suns;
    } else {
      seen.push_back(i);
      seen_bounds.push_back(light.bounds);
    }
  }
  if (seen.size() > kMostSeenLamps || seen_suns > kMostSeenSuns)
    warnings_.push_back(fmt::format(
        "Mirrors show {} of {} soft lamps: make small ones points, or hide some.",
        std::min(seen.size(), kMostSeenLamps) + std::min(seen_suns, kMostSeenSuns),
        seen.size() + seen_suns));
  seen_suns = std::min(seen_suns, kMostSeenSuns);
  seen.resize(std::min(seen.size(), kMostSeenLamps));
  seen_bounds.resize(seen.size());

  LightTree tree = build_light_tree(bounds);
  const LightTree seen_tree = build_light_tree(seen_bounds, uint32_t(tree.nodes.size()));
  constants_.first_seen = uint32_t(tree.nodes.size());
  for (LightNode node : seen_tree.nodes) {
    if (node.child & NODE_LEAF) node.child = NODE_LEAF | seen[node.child & NODE_INDEX];
    tree.nodes.push_back(node);
  }
  constants_.end_seen = uint32_t(tree.nodes.size());
  constants_.seen_suns = uint32_t(seen_suns);

  std::vector<LightRecord> records;
  for (uint32_t i = 0; i < count_; ++i) {
    records.push_back(lights[i].record);
    records.back().edge_x.w = std::bit_cast<float>(tree.trails[i]);
  }
  record_texture_ = store(records_, GL_RGBA32UI, records.data(), records.size() * RECORD_TEXELS, 16,
                          "lamps and glowing triangles");
  node_texture_ = store(nodes_, GL_RGBA32UI, tree.nodes.data(), tree.nodes.size() * NODE_TEXELS, 16,
                        "lamps and glowing triangles");
  map_primitives(count_ - uint32_t(triangles_.size()));
}

void Lights::map_primitives(uint32_t first_record) {
  std::vector<uint32_t> map;
  const auto primitive = [&](size_t i) {
    return std::bit_cast<uint32_t>(triangles_[i].record.edge_y.w);
  };
  if (!triangles_.empty()) {
    constants_.first_glowing = primitive(0);
    map.assign(primitive(triangles_.size() - 1) - primitive(0) + 1, shared::NO_LIGHT);
  }
  for (size_t i = 0; i < triangles_.size(); ++i)
    map[primitive(i) - constants_.first_glowing] = first_record + uint32_t(i);
  constants_.glowing_count = uint32_t(map.size());
  glowing_texture_ = store(glowing_, GL_R32UI, map.data(), map.size(), 4, "triangles");
}

gl::Texture Lights::store(gl::Buffer& buffer, GLenum format, const void* data, size_t texels,
                          size_t texel_bytes, const char* what) const {
  if (texels == 0) {
    buffer = gl::Buffer();
    return {};
  }
  if (texels > size_t(device_.max_texture_buffer_texels))
    fail("the scene has more {} than this graphics driver can address: make fewer surfaces glow, or "
         "hide objects",
         what);
  buffer = gl::Buffer();  // before the new one takes its memory
  buffer = gl::Buffer(int64_t(texels * texel_bytes), data);
  return gl::Texture(format, buffer);
}

void Lights::add_defines(gl::ProgramSource& source) const {
  const bool local = kinds_.points || kinds_.spots || kinds_.areas || kinds_.triangles;
  const auto define = [&](const char* name, bool value) {
    source.defines.push_back(fmt::format("{} {}", name, int(value)));
  };
  define("LIGHT_ANY", count_ > 0);
  define("LIGHT_TREE", count_ > 1);
  define("LIGHT_LOCAL", local);
  define("LIGHT_SUNS", kinds_.suns);
  define("LIGHT_POINTS", kinds_.points);
  define("LIGHT_SPOTS", kinds_.spots);
  define("LIGHT_AREAS", kinds_.areas);
  define("LIGHT_TRIANGLES", kinds_.triangles);
  define("LAMPS_SEEN", kinds_.seen);
  define("WORLD_SAMPLED", world_sampled());
}

void Lights::bind() const {
  if (record_texture_) record_texture_.bind(kRecordUnit);
  if (node_texture_) node_texture_.bind(kNodeUnit);
  if (glowing_texture_) glowing_texture_.bind(kGlowingUnit);
  if (world_sampled()) world_.texture().bind(kWorldMapUnit);
  if (constant_block_) glBindBufferBase(GL_UNIFORM_BUFFER, kLightBlock, constant_block_.id());
}

int64_t Lights::bytes() const {
  return records_.bytes() + nodes_.bytes() + glowing_.bytes() + constant_block_.bytes() + world_.bytes();
}

}  // namespace panoptes::path_tracer
