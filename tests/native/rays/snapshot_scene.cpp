#include "base/error.h"
#include "engine/snapshot.h"
#include "rays/scenes.h"

#include <glm/gtc/matrix_transform.hpp>

#include <filesystem>

namespace panoptes::test {

RayScene snapshot_scene(const std::string& path) {
  scene::Scene scene;
  const engine::RenderRequest request = engine::read_snapshot(path, scene);
  const scene::Bounds world = scene.bounds();
  if (world.empty()) fail("'{}' shows no triangle: choose a scene with geometry", path);
  const glm::vec3 middle = 0.5f * (world.low + world.high);

  RayScene result;
  result.name = std::filesystem::path(path).stem().string();
  for (size_t i = 0; i < scene.instances().size(); ++i) {
    const scene::Instance& instance = scene.instances()[i];
    const scene::Mesh* mesh = scene.mesh_of(instance);
    if (!mesh) continue;
    // One translation less the middle, so that nothing is rounded at the size of world coordinates.
    glm::mat4 place = instance.object_to_world;
    place[3] -= glm::vec4(middle, 0);
    for (size_t n = 0; n < mesh->triangles.size(); ++n) {
      glm::vec3 p[3];
      for (int k = 0; k < 3; ++k)
        p[k] = glm::vec3(place * glm::vec4(mesh->positions[mesh->triangles[n][k]], 1));
      TracedTriangle t = make_triangle(p[0], p[1], p[2], instance.visibility);
      t.instance = uint32_t(i);
      t.triangle = uint32_t(n);
      result.triangles.push_back(t);
    }
  }
  result.bounds = bounds_of(result.triangles);
  result.camera_from_scene =
      request.camera.world_to_camera * glm::translate(glm::dmat4(1), glm::dvec3(middle));
  result.projection = request.camera.projection;
  return result;
}

}  // namespace panoptes::test
