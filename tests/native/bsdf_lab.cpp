#include "bsdf_lab.h"

#include "gl/dispatch.h"

#include <cmath>
#include <random>

namespace panoptes::test {

namespace {

constexpr const char* kLobes = R"(
#include "base/bsdf.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Setup { vec4 setup[12]; };
layout(std430, binding = 1) readonly buffer Pairs { vec4 pairs[]; };
layout(std430, binding = 2) writeonly buffer Results { vec4 results[]; };

// By way of memory, as the path tracer has them.
Lobes lab_lobes(vec3 view) {
  Lobes l;
  l.geometric_normal = setup[0].xyz;
  l.diffuse_roughness = setup[0].w;
  l.smooth_normal = setup[1].xyz;
  l.specular_ior = setup[1].w;
  l.diffuse = setup[2].xyz;
  l.alpha = setup[2].w;
  l.normal = setup[3].xyz;
  l.transmission_alpha = setup[3].w;
  l.specular = setup[4].xyz;
  l.ior = setup[4].w;
  l.grazing = setup[5].xyz;
  l.sheen_roughness = setup[5].w;
  l.specular_normal = setup[6].xyz;
  l.coat = setup[6].w;
  l.transmission = setup[7].xyz;
  l.coat_alpha = setup[7].w;
  l.transmission_normal = setup[8].xyz;
  l.sheen = setup[9].xyz;
  l.sheen_normal = setup[10].xyz;
  l.coat_normal = setup[11].xyz;
  uvec4 texels[LOBES_TEXELS];
  pack_lobes(l, texels);
  return unpack_lobes(texels, view);
}

void store(uint at, BsdfValue value) {
  results[at] = vec4(value.diffuse, value.pdf);
  results[at + 1u] = vec4(value.glossy, 0.0);
  results[at + 2u] = vec4(value.transmission, 0.0);
}
)";

constexpr const char* kEvaluate = R"(
#include "lab/lobes.glsl"
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (2u * i >= pairs.length()) return;
  store(3u * i, bsdf_evaluate(lab_lobes(pairs[2u * i].xyz), pairs[2u * i + 1u].xyz));
}
)";

constexpr const char* kDraw = R"(
#include "lab/lobes.glsl"
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (2u * i >= pairs.length()) return;
  BsdfSample s = bsdf_sample(lab_lobes(pairs[2u * i].xyz), pairs[2u * i + 1u].xyz);
  results[5u * i] = vec4(s.direction, s.pdf);
  store(5u * i + 1u, s.value);
  results[5u * i + 4u] = vec4(s.singular ? 1.0 : 0.0, float(s.kind), 0.0, 0.0);
}
)";

gl::ProgramSource lab_program(const char* name, const std::string& main) {
  gl::ProgramSource source;
  source.name = name;
  source.stages = {{GL_COMPUTE_SHADER, "lab/main.comp"}};
  source.snippets = {{"lab/main.comp", main}, {"lab/lobes.glsl", kLobes}};
  source.defines = {"GLOSSY 1", "TRANSMISSION 1", "LAYERS 1", "ALPHA 0", "IMAGE_COUNT 0"};
  return source;
}

}  // namespace

template <class T>
std::vector<T> BsdfLab::run(const gl::ProgramSource& source, const LabLobes& lobes,
                            const std::vector<LabPair>& pairs, size_t count) {
  const gl::Buffer setup(sizeof(lobes), &lobes);
  const gl::Buffer in{std::span<const LabPair>(pairs)};
  const gl::Buffer out(int64_t(count * sizeof(T)));
  programs_.get(source).use();
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, setup.id());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, in.id());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, out.id());
  glDispatchCompute(GLuint((count + 63) / 64), 1, 1);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  std::vector<T> results(count);
  out.read(0, out.bytes(), results.data());
  return results;
}

std::vector<LabValue> BsdfLab::evaluate(const LabLobes& lobes, const std::vector<LabPair>& pairs) {
  return run<LabValue>(lab_program("evaluate", kEvaluate), lobes, pairs, pairs.size());
}

std::vector<LabSample> BsdfLab::draw(const LabLobes& lobes, const glm::dvec3& view, int count,
                                     uint32_t seed) {
  std::mt19937 bits(seed);
  const auto random = [&] { return float(bits() >> 8) / 16777216.0f; };
  std::vector<LabPair> pairs;
  for (int i = 0; i < count; ++i) {
    const float x = random(), y = random(), z = random();
    pairs.push_back({glm::vec4(view, 0), {x, y, z, 0}});
  }
  return run<LabSample>(lab_program("draw", kDraw), lobes, pairs, pairs.size());
}

std::vector<glm::vec4> BsdfLab::run(const std::string& main, int count) {
  gl::ProgramSource source = lab_program("closures", R"(
#include "gpu_scene/material.glsl"
#include "base/bsdf.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 2) writeonly buffer Results { vec4 results[]; };
#include "lab/body.glsl"
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < results.length()) results[i] = lab(i);
}
)");
  source.snippets["lab/body.glsl"] = main;
  source.defines.push_back("LOBES_APART 1");
  return run<glm::vec4>(source, {}, {{}}, size_t(count));
}

DirectionGrid::DirectionGrid(const glm::dvec3& pole, double power) : power_(power) {
  const glm::dvec3 z = glm::normalize(pole);
  const glm::dvec3 x = glm::normalize(
      glm::cross(std::abs(z.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0), z));
  frame_ = glm::dmat3(x, glm::cross(z, x), z);
}

double DirectionGrid::angle(double t) const { return kPi * std::pow(t, power_); }

glm::dvec3 DirectionGrid::direction(int ring, int sector) const {
  const double theta = angle((ring + 0.5) / kRings), phi = 2 * kPi * (sector + 0.5) / kSectors;
  return frame_ * glm::dvec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                             std::cos(theta));
}

double DirectionGrid::solid_angle(int ring) const {
  // 1 - cos as twice a squared sine: the innermost rings are narrow.
  const double inner = std::sin(0.5 * angle(double(ring) / kRings));
  const double outer = std::sin(0.5 * angle((ring + 1.0) / kRings));
  return 2 * kPi / kSectors * 2 * (outer * outer - inner * inner);
}

int DirectionGrid::cell(const glm::dvec3& direction) const {
  const glm::dvec3 local = glm::transpose(frame_) * direction;
  const double theta = std::atan2(std::hypot(local.x, local.y), local.z);
  const double phi = std::atan2(local.y, local.x) / (2 * kPi);
  const int ring = std::min(int(kRings * std::pow(theta / kPi, 1 / power_)), kRings - 1);
  const int sector = std::min(int(kSectors * (phi < 0 ? phi + 1 : phi)), kSectors - 1);
  return ring * kSectors + sector;
}

std::vector<LabPair> DirectionGrid::pairs(const glm::dvec3& view) const {
  std::vector<LabPair> result;
  for (int ring = 0; ring < kRings; ++ring)
    for (int sector = 0; sector < kSectors; ++sector)
      result.push_back({glm::vec4(view, 0), glm::vec4(direction(ring, sector), 0)});
  return result;
}

glm::dvec3 view_at(double cosine, double turned) {
  const double sine = std::sqrt(1 - cosine * cosine);
  return {sine * std::cos(turned), sine * std::sin(turned), cosine};
}

glm::dvec3 mirrored(const glm::dvec3& view) { return {-view.x, -view.y, view.z}; }

}  // namespace panoptes::test
