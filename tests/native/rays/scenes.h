// Scenes that rays are traced through: generated ones, and snapshots of .blend files.
//
// Positions are relative to the middle of the scene's bounds, as the list of all triangles has
// them.
#pragma once

#include "gpu_scene/view.h"
#include "rays/triangles.h"

#include <string>
#include <vector>

namespace panoptes::test {

struct RayScene {
  std::string name;
  Triangles triangles;
  scene::Bounds bounds;
  glm::dmat4 camera_from_scene{1.0}, projection{1.0};  // as gpu_scene::Camera has them
};

// A two-storeyed hall with columns, arches, curtains and balls, much like the Sponza atrium: 206
// 372 triangles of all sizes, the camera inside.
RayScene atrium();
// A room of 2 m with a lamp and two boxes: 36 triangles.
RayScene box_room();
// 50 000 triangles of centimetres and eight that cross the whole scene of 20 m.
RayScene soup();
// A finely tessellated closed shape that swells and twists with `time` (s); 160 000 triangles.
RayScene blob(float time = 0);
// A field of 20 000 blades of grass, each a sliver of 1 : 200, over ground.
RayScene grass();

// Names of the scenes above, and the scene of a name. Throws Error for another name.
std::vector<std::string> generated_scene_names();
RayScene generated_scene(const std::string& name);

// The triangles of all instances of a snapshot (engine/snapshot.h), and its camera. Throws Error.
RayScene snapshot_scene(const std::string& path);

}  // namespace panoptes::test
