#include "tracing/hit_bins.h"

#include "gl/dispatch.h"
#include "gpu_scene/units.h"

#include <fmt/format.h>

#include <numeric>

namespace panoptes::tracing {

gl::ProgramSource hits_by_material_program(bool listed, bool placed, bool alpha_only) {
  gl::ProgramSource source;
  source.name = "hits by material";
  source.stages = {{GL_COMPUTE_SHADER, "tracing/hits_by_material.comp"}};
  source.defines = {fmt::format("LISTED {}", int(listed)), fmt::format("PLACED {}", int(placed)),
                    fmt::format("ALPHA_ONLY {}", int(alpha_only))};
  return source;
}

void HitBins::sort(const Rays& rays, uint32_t materials, const TriangleList& triangles,
                   gl::ProgramCache& programs) {
  // Bindings of shaders/tracing/hits_by_material.comp.
  constexpr unsigned kHits = 0, kListed = 3, kSorted = 4, kBins = 5;
  const int64_t bins_bytes = (int64_t(materials) + 1) * 4;
  bins_.reserve(bins_bytes);
  sorted_.reserve(int64_t(rays.count) * 4);
  const auto pass = [&](bool placed) {
    programs.get(hits_by_material_program(rays.listed != nullptr, placed, rays.alpha_only)).use();
    triangles.texture().bind(gpu_scene::kFreeUnit);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kHits, rays.hits.id());
    if (rays.listed) glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kListed, rays.listed->id());
    if (placed) glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kSorted, sorted_.id());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kBins, bins_.id());
    glUniform1ui(1, rays.count);
    glUniform1ui(2, materials);
    gl::dispatch(rays.count, GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                                 GL_BUFFER_UPDATE_BARRIER_BIT);
  };
  bins_.clear();
  pass(false);
  counts_.resize(materials + 1);
  bins_.read(0, bins_bytes, counts_.data());
  std::vector<uint32_t> firsts(counts_.size());
  std::exclusive_scan(counts_.begin(), counts_.end(), firsts.begin(), 0u);
  if (firsts.back() + counts_.back() == 0) return;
  bins_.write(0, bins_bytes, firsts.data());
  pass(true);
}

}  // namespace panoptes::tracing
