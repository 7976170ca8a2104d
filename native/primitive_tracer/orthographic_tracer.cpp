#include "primitive_tracer/orthographic_tracer.h"

#include "base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace panoptes::primitive_tracer {

namespace {

constexpr int kMostTiles = 1024, kMostDivisions = 4;

// Entries that a build may have at all: 1 GiB of them.
constexpr uint32_t kMostEntries = 1u << 27;

// And where tiles are chosen by us: many triangles that each cross most of the scene get larger tiles
// instead.
uint32_t entry_limit(uint32_t triangles) {
  return uint32_t(std::min<uint64_t>(uint64_t(triangles) * 32 + (1u << 20), kMostEntries));
}

int chosen_tiles(uint32_t triangles) {
  const unsigned side = std::bit_floor(unsigned(std::sqrt(triangles / 24.0)));
  return std::clamp(int(side), triangles < 256 ? 1 : 32, 512);
}

int chosen_part(uint32_t triangles) { return std::clamp(int(triangles / 5000), 4, 40); }

gl::ProgramSource pass(const char* name, const char* file, const char* define = nullptr) {
  gl::ProgramSource source;
  source.name = fmt::format("structure: {}", name);
  source.stages = {{GL_COMPUTE_SHADER, fmt::format("primitive_tracer/{}", file)}};
  source.snippets["generated/views.glsl"] = "#include \"primitive_tracer/orthographic_raster.glsl\"\n";
  if (define) source.defines = {define};
  return source;
}

gl::ProgramSource density() { return pass("density", "density.comp"); }
gl::ProgramSource divide() { return pass("divide", "divide.comp"); }
gl::ProgramSource raster_triangles(bool listed) {
  return pass("triangles", "raster_triangles.comp", listed ? "LISTED 1" : "LISTED 0");
}
gl::ProgramSource raster_blocks(bool listed) {
  return pass("blocks", "raster_blocks.comp", listed ? "LISTED 1" : "LISTED 0");
}
gl::ProgramSource begin_lists() { return pass("lists", "begin_lists.comp"); }
gl::ProgramSource order_lists() { return pass("order", "order_lists.comp"); }
gl::ProgramSource sort_lists(bool crowded) {
  return pass("sorting", "sort_lists.comp", crowded ? "CROWDED 1" : "CROWDED 0");
}
gl::ProgramSource gather() { return pass("gather", "gather.comp"); }
gl::ProgramSource pyramid() { return pass("pyramid", "pyramid.comp"); }

}  // namespace

std::vector<gl::ProgramSource> orthographic_build_programs() {
  return {density(),     divide(),          raster_triangles(false), raster_triangles(true),
          begin_lists(), sort_lists(false), raster_blocks(false),    raster_blocks(true),
          order_lists(), sort_lists(true),  gather(),                pyramid()};
}

OrthographicTracer::OrthographicTracer(const OrthographicSettings& settings, const PoolSizes& first)
    : settings_(settings), first_(first) {
  const auto check = [](int value, int least, int most, const char* what) {
    if (value < least || value > most)
      fail("the structure for ray tracing was asked for {} {}: choose {} to {}", value, what, least,
           most);
  };
  check(settings.tiles, 0, kMostTiles, "tiles a side");
  check(settings.divisions, 0, kMostDivisions, "divisions of a tile");
  check(settings.triangles_a_part, 0, 1 << 20, "triangles a part");
  check(settings.buckets_per_triangle, 1, int(shared::MOST_BUCKETS), "buckets per triangle");
}

void OrthographicTracer::place(const scene::Bounds& bounds, int tiles) {
  // A little more than the scene, so that nothing lies on the border, and never flat.
  glm::vec3 low(0), size(1);
  float uncertain = 5e-7f;  // metres, of coordinates as large as these
  if (!bounds.empty()) {
    size = bounds.high - bounds.low;
    const glm::vec3 largest = glm::max(size, glm::max(glm::abs(bounds.low), glm::abs(bounds.high)));
    uncertain *= std::max({largest.x, largest.y, largest.z, 1e-30f});
    const glm::vec3 margin = size * 1e-4f + 10.0f * uncertain;
    low = bounds.low - margin;
    size += 2.0f * margin;
  }
  const int axis = size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2;
  const float across = std::max(size[(axis + 1) % 3], size[(axis + 2) % 3]);
  view_.low = glm::vec4(low, float(tiles) / across);
  view_.depth = glm::vec4(1.0f / size[axis], std::max(2e-6f, uncertain / size[axis]), uncertain, 0);
  const int levels_above = (tiles * tiles - 1) / 3;
  view_.grid = {axis, tiles, std::countr_zero(unsigned(tiles)), levels_above};
  if (!view_block_) view_block_ = gl::Buffer(sizeof view_);
  view_block_.write(0, sizeof view_, &view_);
}

void OrthographicTracer::reserve() {
  const PoolSizes& sizes = pools_.sizes();
  const int64_t nodes = int64_t(view_.grid.w) + view_.grid.y * view_.grid.y + sizes.nodes;
  if (nodes_.reserve(nodes * 16)) node_texture_ = gl::Texture(GL_RGBA32UI, nodes_);
  order_.reserve((nodes - view_.grid.w) * 4);
  lists_.reserve(nodes * int64_t(sizeof(shared::NodeList)));
  if (offsets_.reserve(int64_t(sizes.offsets) * 4)) offset_texture_ = gl::Texture(GL_R32UI, offsets_);
  if (ids_.reserve(int64_t(sizes.ids) * 4)) id_texture_ = gl::Texture(GL_R32UI, ids_);
}

void OrthographicTracer::build(const tracing::TriangleList& triangles, gl::ProgramCache& programs,
                               gl::PassTimer& timer) {
  const uint32_t count = triangles.count();
  const bool chosen = settings_.tiles == 0;
  int tiles = chosen ? chosen_tiles(count) : int(std::bit_ceil(unsigned(settings_.tiles)));
  PoolSizes sizes = first_.entries ? first_ : first_sizes(count);
  triangles.texture().bind(tracing::kTriangleUnit);
  for (bool fitted = false; !fitted;) {
    place(triangles.bounds(), tiles);
    pools_.begin(sizes, count, uint32_t(tiles * tiles),
                 chosen && tiles > 1 ? entry_limit(count) : kMostEntries,
                 sizeof(shared::NodeEntry));
    reserve();
    glBindBufferBase(GL_UNIFORM_BUFFER, tracing::kStructureBlock, view_block_.id());
    run_passes(count, programs, timer);
    fitted = pools_.fitted();
    if (fitted || !pools_.over_limit()) continue;
    if (!chosen || tiles == 1)
      fail("the scene's triangles cross more than {} cells of the structure for ray tracing: choose "
           "fewer tiles, or hide or simplify objects",
           kMostEntries);
    tiles /= 2;
  }
}

void OrthographicTracer::run_passes(uint32_t triangles, gl::ProgramCache& programs,
                                    gl::PassTimer& timer) {
  using Indirect = BuildPools::Indirect;
  const auto bind = [&](unsigned binding, const gl::Buffer& buffer) {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer.id());
  };
  bind(3, nodes_);
  bind(4, lists_);
  bind(5, offsets_);
  bind(6, ids_);
  bind(7, order_);
  const uint32_t tiles = uint32_t(view_.grid.y * view_.grid.y);
  {
    gl::PassScope scope(timer, "structure_divide");
    const uint32_t zero = 0;
    glClearNamedBufferSubData(lists_.id(), GL_R32UI, view_.grid.w * int64_t(sizeof(shared::NodeList)),
                              tiles * sizeof(shared::NodeList), GL_RED_INTEGER, GL_UNSIGNED_INT,
                              &zero);
    pools_.use(programs.get(density()));
    BuildPools::dispatch(triangles);
    pools_.use(programs.get(divide()));
    const int part =
        settings_.triangles_a_part ? settings_.triangles_a_part : chosen_part(triangles);
    glUniform2ui(3, uint32_t(part), uint32_t(settings_.divisions));
    BuildPools::dispatch(tiles);
  }
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  node_texture_.bind(tracing::kStructureUnit);
  for (const bool listed : {false, true}) {
    gl::PassScope scope(timer, listed ? "structure_list" : "structure_count");
    pools_.use(programs.get(raster_triangles(listed)));
    BuildPools::dispatch(triangles);
    if (!listed) pools_.write_arguments(programs);
    pools_.use(programs.get(raster_blocks(listed)));
    pools_.dispatch(Indirect::kBlocks);
    if (listed) continue;
    pools_.use(programs.get(begin_lists()));
    pools_.dispatch(Indirect::kNodes);
  }
  {
    gl::PassScope scope(timer, "structure_sort");
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    pools_.entries().bind(tracing::kStructureUnit);
    pools_.use(programs.get(order_lists()));
    pools_.dispatch(Indirect::kNodes);
    pools_.write_arguments(programs);
    pools_.use(programs.get(sort_lists(false)));
    glUniform1ui(3, uint32_t(settings_.buckets_per_triangle));
    pools_.dispatch(Indirect::kNodes);
    pools_.use(programs.get(sort_lists(true)));
    glUniform1ui(3, uint32_t(settings_.buckets_per_triangle));
    pools_.dispatch(Indirect::kCrowded);
  }
  gl::PassScope scope(timer, "structure_pyramid");
  pools_.use(programs.get(gather()));
  BuildPools::dispatch(tiles);
  pools_.use(programs.get(pyramid()));
  for (int side = view_.grid.y / 2; side > 0; side /= 2) {
    glUniform1i(3, side);
    BuildPools::dispatch(uint32_t(side * side));
  }
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

void OrthographicTracer::add_to(gl::ProgramSource& source) const {
  source.snippets["generated/tracer.glsl"] =
      "#include \"primitive_tracer/orthographic_traverse.glsl\"\n";
}

void OrthographicTracer::bind() const {
  node_texture_.bind(tracing::kStructureUnit);
  offset_texture_.bind(tracing::kStructureUnit + 1);
  id_texture_.bind(tracing::kStructureUnit + 2);
  glBindBufferBase(GL_UNIFORM_BUFFER, tracing::kStructureBlock, view_block_.id());
}

int64_t OrthographicTracer::bytes() const {
  const shared::BuildCounters& counts = pools_.counts();
  return 16 * (int64_t(view_.grid.w) + view_.grid.y * view_.grid.y + counts.nodes) + 4 * int64_t(counts.offsets) +
         4 * int64_t(counts.ids);
}

}  // namespace panoptes::primitive_tracer
