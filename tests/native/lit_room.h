// A room whose walls colour the light that they bounce: 4 m wide, 3 m high, open towards -y.
#pragma once

#include "support.h"

#include <cmath>

namespace panoptes::test {

inline TestScene lit_room() {
  TestScene s;
  const Id grey = s.add_material(lambert(glm::vec3(0.7f)));
  for (float z : {0.0f, 3.0f}) s.add_object(floor_at(z, 2), {grey});
  s.add_object(quad({-2, 0, 1.5f}, {0, 2, 0}, {0, 0, 1.5f}), {s.add_material(lambert({0.8f, 0.1f, 0.1f}))});
  s.add_object(quad({2, 0, 1.5f}, {0, 2, 0}, {0, 0, 1.5f}), {s.add_material(lambert({0.1f, 0.8f, 0.1f}))});
  s.add_object(quad({0, 2, 1.5f}, {2, 0, 0}, {0, 0, 1.5f}), {grey});
  s.lights = {area({0, 0, 2.9f}, {0, 0, -1}, 60, scene::AreaShape::kSquare, 0.8f, 0.8f)};
  return s;
}

// From outside, of its inside.
inline gpu_scene::Camera into_the_room(int width, int height) {
  return perspective({0, -4, 1.5}, {0, 0, 1.5}, 0.8, width, height);
}

// Renders to the end; throws what the job threw.
inline std::shared_ptr<engine::Job> finished(const engine::RenderRequest& request, engine::TakeOver over = {}) {
  const auto job = shared_engine().render(request, std::move(over));
  EXPECT_TRUE(job->wait(120));
  job->check();
  return job;
}

// Root mean square.
inline double apart(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += std::pow(double(a[i]) - b[i], 2);
  return std::sqrt(sum / double(a.size()));
}

}  // namespace panoptes::test
