#include "primitive_tracer/cube_tracer.h"

#include "base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace panoptes::primitive_tracer {

namespace {

constexpr int kMostTiles = 1024, kMostBuckets = 255;

std::vector<std::string> defines(const CubeSettings& settings) {
  return {fmt::format("SINGLE_VIEW {}", int(settings.single_view.has_value())),
          fmt::format("LINKED_LISTS {}", int(settings.linked_lists)),
          fmt::format("THESIS_REJECTION {}", int(settings.thesis_rejection)),
          fmt::format("NODE_WORDS {}", settings.linked_lists ? 2 : 4)};
}

gl::ProgramSource pass(const CubeSettings& settings, const char* file, int placed = -1) {
  gl::ProgramSource source;
  source.name = fmt::format("cube structure: {}", file);
  source.stages = {{GL_COMPUTE_SHADER, fmt::format("primitive_tracer/{}", file)}};
  source.snippets["generated/views.glsl"] = "#include \"primitive_tracer/cube_raster.glsl\"\n";
  source.defines = defines(settings);
  if (placed >= 0) source.defines.push_back(fmt::format("PLACED {}", placed));
  return source;
}

gl::ProgramSource hardware_pass(const CubeSettings& settings, bool conservative) {
  gl::ProgramSource source;
  source.name = "cube structure: raster by hardware";
  source.stages = {{GL_VERTEX_SHADER, "primitive_tracer/cube_raster.vert"},
                   {GL_GEOMETRY_SHADER, "primitive_tracer/cube_raster.geom"},
                   {GL_FRAGMENT_SHADER, "primitive_tracer/cube_raster.frag"}};
  source.defines = defines(settings);
  source.defines.push_back(fmt::format("CONSERVATIVE {}", int(conservative)));
  return source;
}

// About two triangles a tile, the power of two that is nearest: 128 a side for the cube of 206 k
// triangles, where 64 tests twice as many triangles and 256 visits half as many cells again.
int chosen_tiles(uint32_t triangles) {
  const double side = std::sqrt(std::max(triangles, 1u) / 12.0);
  return std::clamp(int(std::lround(std::exp2(std::round(std::log2(side))))), 4, 256);
}

}  // namespace

std::vector<gl::ProgramSource> cube_build_programs(const CubeSettings& settings) {
  std::vector<gl::ProgramSource> sources = {pass(settings, "raster_triangles.comp"),
                                            pass(settings, "raster_blocks.comp"),
                                            pass(settings, "cube_bounds.comp"),
                                            hardware_pass(settings, false),
                                            hardware_pass(settings, true)};
  for (int placed : {0, 1}) {
    if (!settings.linked_lists) sources.push_back(pass(settings, "cube_buckets.comp", placed));
    sources.push_back(pass(settings, "cube_fill.comp", placed));
  }
  return sources;
}

CubeTracer::CubeTracer(const CubeSettings& settings, const PoolSizes& first)
    : settings_(settings), first_(first) {
  if (settings.tiles < 0 || settings.tiles > kMostTiles)
    fail("{} tiles a side were asked for: choose 1 to {}, or 0 for as many as the scene needs",
         settings.tiles, kMostTiles);
  if (settings.thesis_rejection && !settings.linked_lists)
    fail("the thesis' rejection of hits goes with its linked lists: choose these as well");
  if (!(settings.buckets_per_triangle > 0))
    fail("{} depth intervals for each triangle were asked for: choose a positive number",
         settings.buckets_per_triangle);
  if (settings.buckets < 1 || settings.buckets > kMostBuckets)
    fail("{} depth intervals were asked for: choose 1 to {}", settings.buckets, kMostBuckets);
}

int64_t CubeTracer::base_tiles() const {
  return (settings_.single_view ? 1 : 6) * int64_t(views_.grid.x) * views_.grid.x;
}

int64_t CubeTracer::nodes() const {
  return (4 * base_tiles() - (settings_.single_view ? 1 : 6)) / 3;
}

void CubeTracer::place(const scene::Bounds& bounds, int tiles) {
  const bool empty = bounds.empty();
  const glm::vec3 low = empty ? glm::vec3(0) : bounds.low,
                  high = empty ? glm::vec3(0) : bounds.high;
  const glm::vec3 size = high - low;
  glm::vec3 centre = settings_.centre.value_or(low + size * glm::vec3(0.5137f, 0.5071f, 0.4887f));
  if (settings_.single_view) {
    const SingleView& view = *settings_.single_view;
    centre = view.eye;
    views_.view_x = glm::vec4(view.right / view.half_extent.x, 0);
    views_.view_y = glm::vec4(view.up / view.half_extent.y, 0);
    views_.view_z = glm::vec4(view.forward, 0);
  }
  // Depth along an axis is no more than the distance to a corner; a little more for rounding.
  const glm::vec3 far = glm::max(glm::abs(high - centre), glm::abs(low - centre));
  const float reach = std::max(1.0001f * glm::length(far), 1e-30f);
  views_.centre = glm::vec4(centre, 1.0f / reach);
  const glm::vec3 margin = size * 1e-5f + 4.0f * shared::POSITION_ERROR * reach;
  views_.low = glm::vec4(low - margin, 0);
  views_.high = glm::vec4(high + margin, 0);
  views_.grid = {tiles, std::countr_zero(unsigned(tiles)), settings_.buckets, 0};
  if (!view_block_) view_block_ = gl::Buffer(sizeof views_);
  view_block_.write(0, sizeof views_, &views_);
}

void CubeTracer::reserve() {
  const PoolSizes& sizes = pools_.sizes();
  const bool linked = settings_.linked_lists;
  if (nodes_.reserve(nodes() * (linked ? 8 : 16)))
    node_texture_ = gl::Texture(linked ? GL_RG32UI : GL_RGBA32UI, nodes_);
  ranges_.reserve(base_tiles() * int64_t(sizeof(shared::TileRange)));
  if (offsets_.reserve(linked ? base_tiles() * settings_.buckets * 4 : int64_t(sizes.offsets) * 4))
    offset_texture_ = gl::Texture(GL_R32UI, offsets_);
  if (ids_.reserve(int64_t(sizes.ids) * (linked ? 8 : 4)))
    id_texture_ = gl::Texture(linked ? GL_RG32UI : GL_R32UI, ids_);
}

void CubeTracer::build(const tracing::TriangleList& triangles, gl::ProgramCache& programs,
                       gl::PassTimer& timer) {
  const uint32_t count = triangles.count();
  const int asked = settings_.tiles == 0 ? 0 : int(std::bit_ceil(unsigned(settings_.tiles)));
  int tiles = asked ? asked : chosen_tiles(count);
  GLint texels = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &texels);
  const uint32_t most = settings_.most_entries ? settings_.most_entries : uint32_t(texels);
  // Where tiles are chosen, many triangles that each cross most of the scene get larger ones.
  const uint32_t limit =
      asked ? most : uint32_t(std::min<uint64_t>(most, uint64_t(count) * 8 + (1u << 18)));
  const PoolSizes sizes = first_.entries ? first_ : first_sizes(count);
  triangles.texture().bind(tracing::kTriangleUnit);
  for (bool fitted = false; !fitted;) {
    place(triangles.bounds(), tiles);
    pools_.begin(sizes, count, uint32_t(base_tiles()), limit);
    reserve();
    glBindBufferBase(GL_UNIFORM_BUFFER, tracing::kStructureBlock, view_block_.id());
    run_passes(count, programs, timer);
    fitted = pools_.fitted();
    if (fitted || !pools_.over_limit()) continue;
    if (tiles == 1)
      fail("the scene's {} triangles are too many for the structure for ray tracing: hide or "
           "simplify objects",
           count);
    tiles /= 2;
  }
  if (asked && tiles != asked)
    fail("with {} tiles a side, triangles cross more tiles than the graphics driver can list: "
         "choose "
         "{} tiles or fewer",
         asked, tiles);
}

void CubeTracer::run_passes(uint32_t triangles, gl::ProgramCache& programs, gl::PassTimer& timer) {
  const auto bind = [&](unsigned binding, const gl::Buffer& buffer) {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer.id());
  };
  bind(3, nodes_);
  bind(4, ranges_);
  bind(5, offsets_);
  bind(6, ids_);
  {
    gl::PassScope scope(timer, "structure_raster");
    const shared::TileRange empty{0xffffffffu, 0, 0, 0};
    glClearNamedBufferSubData(ranges_.id(), GL_RGBA32UI, 0, base_tiles() * int64_t(sizeof empty),
                              GL_RGBA_INTEGER, GL_UNSIGNED_INT, &empty);
    if (settings_.hardware_raster)
      raster_by_hardware(triangles, programs);
    else
      raster(triangles, programs);
    pools_.write_arguments(programs);
  }
  {
    gl::PassScope scope(timer, "structure_pyramid");
    pools_.use(programs.get(pass(settings_, "cube_bounds.comp")));
    for (int level = 0; level <= views_.grid.y; ++level) {
      glUniform1i(3, level);
      BuildPools::dispatch(uint32_t(base_tiles() >> (2 * level)));
    }
  }
  gl::PassScope scope(timer, "structure_lists");
  if (settings_.linked_lists)
    link_lists(programs);
  else
    run_lists(programs);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

void CubeTracer::raster(uint32_t triangles, gl::ProgramCache& programs) {
  pools_.use(programs.get(pass(settings_, "raster_triangles.comp")));
  BuildPools::dispatch(triangles);
  pools_.write_arguments(programs);
  pools_.use(programs.get(pass(settings_, "raster_blocks.comp")));
  pools_.dispatch(BuildPools::Indirect::kBlocks);
}

void CubeTracer::raster_by_hardware(uint32_t triangles, gl::ProgramCache& programs) {
  const bool conservative = epoxy_has_gl_extension("GL_NV_conservative_raster");
  const GLsizei side = views_.grid.x;
  if (!framebuffer_) framebuffer_ = gl::Framebuffer::make();
  if (!vertex_array_) vertex_array_ = gl::VertexArray::make();
  glNamedFramebufferParameteri(framebuffer_.id(), GL_FRAMEBUFFER_DEFAULT_WIDTH, side);
  glNamedFramebufferParameteri(framebuffer_.id(), GL_FRAMEBUFFER_DEFAULT_HEIGHT, side);
  glNamedFramebufferParameteri(framebuffer_.id(), GL_FRAMEBUFFER_DEFAULT_LAYERS,
                               settings_.single_view ? 1 : 6);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  glBindVertexArray(vertex_array_.id());
  glViewport(0, 0, side, side);
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_SCISSOR_TEST);
  if (conservative) glEnable(GL_CONSERVATIVE_RASTERIZATION_NV);
  pools_.use(programs.get(hardware_pass(settings_, conservative)));
  glDrawArrays(GL_POINTS, 0, GLsizei(triangles));
  if (conservative) glDisable(GL_CONSERVATIVE_RASTERIZATION_NV);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void CubeTracer::link_lists(gl::ProgramCache& programs) {
  const uint32_t none = shared::NO_LINK;
  glClearNamedBufferData(offsets_.id(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &none);
  pools_.use(programs.get(pass(settings_, "cube_fill.comp", 1)));
  pools_.dispatch(BuildPools::Indirect::kEntries);
}

void CubeTracer::run_lists(gl::ProgramCache& programs) {
  for (int placed : {0, 1}) {
    pools_.use(programs.get(pass(settings_, "cube_buckets.comp", placed)));
    if (placed == 0) glUniform1f(3, settings_.buckets_per_triangle);
    pools_.dispatch(BuildPools::Indirect::kNodes);
    pools_.use(programs.get(pass(settings_, "cube_fill.comp", placed)));
    pools_.dispatch(BuildPools::Indirect::kEntries);
  }
}

void CubeTracer::add_to(gl::ProgramSource& source) const {
  for (const std::string& define : defines(settings_)) source.defines.push_back(define);
  source.snippets["generated/tracer.glsl"] = "#include \"primitive_tracer/cube_traverse.glsl\"\n";
}

void CubeTracer::bind() const {
  node_texture_.bind(tracing::kStructureUnit);
  offset_texture_.bind(tracing::kStructureUnit + 1);
  id_texture_.bind(tracing::kStructureUnit + 2);
  glBindBufferBase(GL_UNIFORM_BUFFER, tracing::kStructureBlock, view_block_.id());
}

CubeTracer::Bytes CubeTracer::bytes_of_parts() const {
  const shared::BuildCounters& counts = pools_.counts();
  if (settings_.linked_lists)
    return {8 * nodes(), 4 * base_tiles() * settings_.buckets, 8 * int64_t(counts.ids)};
  return {16 * nodes(), 4 * int64_t(counts.offsets), 4 * int64_t(counts.ids)};
}

int64_t CubeTracer::bytes() const {
  const Bytes parts = bytes_of_parts();
  return parts.depth_bounds + parts.buckets + parts.ids;
}

int64_t CubeTracer::used_tiles() const {
  const size_t words = settings_.linked_lists ? 2 : 4;
  std::vector<uint32_t> bounds(size_t(base_tiles()) * words);
  nodes_.read(0, int64_t(bounds.size() * sizeof(uint32_t)), bounds.data());
  int64_t used = 0;
  for (size_t i = 0; i < bounds.size(); i += words) used += bounds[i] <= bounds[i + 1];
  return used;
}

}  // namespace panoptes::primitive_tracer
