#include "engine/tracers.h"

#include "base/error.h"
#include "bvh_tracer/bvh_tracer.h"
#include "fragment_tracer/fragment_tracer.h"
#include "primitive_tracer/cube_tracer.h"
#include "primitive_tracer/orthographic_tracer.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace panoptes::engine {

void StructureSettings::check() const {
  if (int(structure) < 0 || size_t(structure) >= kStructureNames.size())
    fail("there is no structure number {} for rays: choose one of {}", int(structure),
         fmt::join(kStructureNames, ", "));
  if (tiles < 0 || tiles > 1024)
    fail("the structure for rays was asked for {} tiles a side: choose 1 to 1024, or 0 for as many as "
         "the scene needs",
         tiles);
  if (buckets < 0 || buckets > 255)
    fail("the structure for rays was asked for {} buckets: choose 1 to 255, or 0 for its own number",
         buckets);
  fragments.check();
}

namespace {

// A frustum about the camera's axis that holds all that the camera sees, through a shifted lens too.
primitive_tracer::SingleView single_view(const gpu_scene::Camera& camera, const glm::dvec3& origin) {
  if (!camera.perspective())
    fail("rays cannot be confined to the view of an orthographic camera: choose another structure");
  const glm::dmat4 world = glm::inverse(camera.world_to_camera);
  const glm::dmat4& p = camera.projection;  // p[column][row]
  primitive_tracer::SingleView view;
  view.eye = glm::vec3(glm::dvec3(world[3]) - origin);
  view.right = glm::vec3(glm::normalize(glm::dvec3(world[0])));
  view.up = glm::vec3(glm::normalize(glm::dvec3(world[1])));
  view.forward = -glm::vec3(glm::normalize(glm::dvec3(world[2])));
  view.half_extent = {float((1.0 + std::abs(p[2][0])) / p[0][0]),
                      float((1.0 + std::abs(p[2][1])) / p[1][1])};
  return view;
}

// Fragments are those of the camera's own pixels, and of a cube about its eye.
std::unique_ptr<tracing::Tracer> fragment_tracer_of(const fragment_tracer::Settings& settings,
                                                    const gpu_scene::Camera& camera, const glm::dvec3& origin) {
  // An orthographic camera has no eye: the cube stands in the middle of the scene, where the list has its origin.
  if (!camera.perspective())
    return std::make_unique<fragment_tracer::FragmentTracer>(settings, glm::vec3(0), std::nullopt);
  const primitive_tracer::SingleView view = single_view(camera, origin);
  // As fine as the picture, and no coarser than the cube.
  const int least = std::max(camera.width, int(std::lround(settings.side * view.half_extent.x)));
  const int width = settings.camera_width > 0 ? settings.camera_width : std::min(least, 16384);
  const int height = std::clamp(int(std::lround(width * view.half_extent.y / view.half_extent.x)), 1, 16384);
  return std::make_unique<fragment_tracer::FragmentTracer>(
      settings, view.eye,
      fragment_tracer::CameraView{view.right, view.up, view.forward, view.half_extent, {width, height}});
}

}  // namespace

std::unique_ptr<tracing::Tracer> make_tracer(const StructureSettings& settings,
                                             const gl::DeviceInfo& device,
                                             const gpu_scene::Camera& camera,
                                             const glm::dvec3& origin) {
  const bool lists = settings.structure == Structure::kLists;
  switch (settings.structure) {
    case Structure::kOrthographic: {
      primitive_tracer::OrthographicSettings s;
      s.tiles = settings.tiles;
      if (settings.buckets) s.buckets_per_triangle = settings.buckets;
      return std::make_unique<primitive_tracer::OrthographicTracer>(s);
    }
    case Structure::kCube:
    case Structure::kView:
    case Structure::kLists: {
      primitive_tracer::CubeSettings s;
      s.linked_lists = lists;
      if (settings.structure == Structure::kView) s.single_view = single_view(camera, origin);
      s.tiles = settings.tiles;
      if (settings.buckets && lists) s.buckets = settings.buckets;
      if (settings.buckets && !lists) s.buckets_per_triangle = float(settings.buckets);
      return std::make_unique<primitive_tracer::CubeTracer>(s);
    }
    case Structure::kBvh: return std::make_unique<bvh_tracer::BvhTracer>(device);
    case Structure::kFragments: return fragment_tracer_of(settings.fragments, camera, origin);
    case Structure::kAuto: break;
  }
  fail("no structure for rays was chosen: please report it");
}

}  // namespace panoptes::engine
