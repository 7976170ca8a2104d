#include "rays/embree_scene.h"

#include "base/error.h"

#include <atomic>
#include <cmath>
#include <limits>
#include <thread>

namespace panoptes::test {

namespace {

std::atomic<int64_t> held_bytes{0};

RTCDevice shared_device() {
  static const RTCDevice device = [] {
    const RTCDevice made = rtcNewDevice(nullptr);
    if (!made) fail("Embree does not start: install libembree-dev again");
    const auto count = [](void*, ssize_t bytes, bool) {
      held_bytes += bytes;
      return true;
    };
    rtcSetDeviceMemoryMonitorFunction(made, count, nullptr);
    return made;
  }();
  return device;
}

RTCRay embree_ray(const TracedRay& ray) {
  RTCRay r{};
  r.org_x = ray.origin_x;
  r.org_y = ray.origin_y;
  r.org_z = ray.origin_z;
  r.tnear = ray.t_min;
  r.dir_x = ray.direction_x;
  r.dir_y = ray.direction_y;
  r.dir_z = ray.direction_z;
  r.tfar = ray.t_max;
  r.mask = ~0u;
  return r;
}

TracedHit closest(RTCScene scene, RTCIntersectContext& context, const TracedRay& ray) {
  RTCRayHit query{};
  query.ray = embree_ray(ray);
  query.hit.geomID = query.hit.primID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {ray.t_max, shared::NO_PRIMITIVE, 0, 0};
  return {query.ray.tfar, query.hit.primID, query.hit.u, query.hit.v};
}

TracedHit any(RTCScene scene, RTCIntersectContext& context, const TracedRay& ray) {
  RTCRay query = embree_ray(ray);
  rtcOccluded1(scene, &context, &query);
  const bool met = query.tfar < 0 && std::isinf(query.tfar);
  return {met ? query.tnear : ray.t_max, met ? 0 : shared::NO_PRIMITIVE, 0, 0};
}

}  // namespace

EmbreeScene::EmbreeScene(const Triangles& triangles, bool robust, RTCBuildQuality quality)
    : scene_(rtcNewScene(shared_device())) {
  if (robust) rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene_, quality);
  const RTCGeometry mesh = rtcNewGeometry(shared_device(), RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetGeometryBuildQuality(mesh, quality);
  const size_t count = triangles.size();
  auto* vertices = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0,
                                                                   RTC_FORMAT_FLOAT3,
                                                                   sizeof(glm::vec3), 3 * count));
  auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0,
                                                                 RTC_FORMAT_UINT3,
                                                                 3 * sizeof(uint32_t), count));
  const glm::vec3 nowhere(std::numeric_limits<float>::quiet_NaN());  // Embree drops the triangle
  for (size_t i = 0; i < 3 * count; ++i) {
    const TracedTriangle& t = triangles[i / 3];
    vertices[i] = seen(t) ? corner(t, int(i % 3)) : nowhere;
    indices[i] = uint32_t(i);
  }
  rtcCommitGeometry(mesh);
  rtcAttachGeometry(scene_, mesh);
  rtcReleaseGeometry(mesh);
  rtcCommitScene(scene_);
}

EmbreeScene::~EmbreeScene() { rtcReleaseScene(scene_); }

std::vector<TracedHit> EmbreeScene::trace(std::span<const TracedRay> rays, bool any_hit) const {
  std::vector<TracedHit> hits(rays.size());
  constexpr size_t kChunk = 1024;
  std::atomic<size_t> next{0};
  const auto work = [&] {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (size_t begin; (begin = next.fetch_add(kChunk)) < rays.size();)
      for (size_t i = begin; i < std::min(begin + kChunk, rays.size()); ++i)
        hits[i] = any_hit ? any(scene_, context, rays[i]) : closest(scene_, context, rays[i]);
  };
  std::vector<std::thread> others(std::max(std::thread::hardware_concurrency(), 1u) - 1);
  for (std::thread& thread : others) thread = std::thread(work);
  work();
  for (std::thread& thread : others) thread.join();
  return hits;
}

int64_t EmbreeScene::bytes() { return held_bytes; }

}  // namespace panoptes::test
