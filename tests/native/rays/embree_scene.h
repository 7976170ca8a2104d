// The same triangles in Embree: the reference for hits, and the yardstick for speed.
#pragma once

#include "rays/triangles.h"

#include <embree3/rtcore.h>

#include <span>
#include <vector>

namespace panoptes::test {

using shared::TracedHit;
using shared::TracedRay;

class EmbreeScene {
 public:
  // Builds on all cores. Triangles that nobody sees are left out.
  explicit EmbreeScene(const Triangles& triangles, bool robust = true,
                       RTCBuildQuality quality = RTC_BUILD_QUALITY_MEDIUM);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  // Traces on all cores, one ray at a time. With any_hit only tells whether something was met:
  // primitive 0 stands for it. TracedRay::after and seen_by are not regarded.
  std::vector<TracedHit> trace(std::span<const TracedRay> rays, bool any_hit = false) const;
  // Held by Embree for all its scenes of this process.
  static int64_t bytes();

 private:
  RTCScene scene_;
};

}  // namespace panoptes::test
