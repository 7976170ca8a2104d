#include "rays/hard_cases.h"

namespace panoptes::test {

const std::vector<HardCaseMaker>& hard_cases() {
  static const std::vector<HardCaseMaker> all = [] {
    std::vector<HardCaseMaker> rows;
    for (const auto& part : {hard_scales(), hard_triangles(), hard_rays()})
      rows.insert(rows.end(), part.begin(), part.end());
    return rows;
  }();
  return all;
}

void add_rays_of_all_kinds(HardCase& to, uint32_t count, float margin) {
  RayScene scene{"", to.triangles, bounds_of(to.triangles), {}, {}};
  const glm::vec3 more = margin * (scene.bounds.high - scene.bounds.low);
  Random random(31);
  for (uint32_t i = 0; i < count; ++i) {
    const glm::vec3 from = random.in_box(scene.bounds.low - more, scene.bounds.high + more);
    const glm::vec3 through = random.in_box(scene.bounds.low, scene.bounds.high);
    to.add(make_ray(from, from == through ? glm::vec3(0, 0, 1) : through - from));
  }
  for (const RaySet& set : aimed_rays(scene, count))
    for (const TracedRay& ray : set.rays)
      if (direction_of(ray) != glm::vec3(0)) to.add(ray);
}

}  // namespace panoptes::test
