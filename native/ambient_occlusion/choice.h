// Which views are worth looking through, by what they tell about a few points of the picture
// (section 4.4.5: "views that do not reveal complementary geometric information [...] should not be
// included"). No GL.
#pragma once

#include <span>
#include <vector>

namespace panoptes::ambient_occlusion {

// Of one point of the picture in one view: O(v, p) and w(v, p) of (4.1). One that is not finite, or
// a weight of 0 or less, says nothing.
struct Estimate {
  float occlusion, weight;
};

// Estimates of all probes lie together: estimates[probe * views + view], view 0 is the camera.
// Probes whose estimate by the camera is not finite are not counted.

// Adds to the camera, one after the other, the view that changes occlusion by (4.1) the most, as
// the mean over all probes (the incremental contribution of Figure 4.9), until there are `most` or
// the best would change it by less than `least` (occlusion is 0 to 1), or by nothing. Returns them
// in this order; of equals, the one with the lower index comes first.
std::vector<int> choose_views(std::span<const Estimate> estimates, int views, int most,
                              float least);

// Share of probes, 0 to 1, that `chosen` views other than the camera see about as reliably as it
// does; 1 where there are no probes. The camera does not count: it sees every probe, and what it
// lacks is what hides behind them. Weights are compared with the camera's, since their size depends
// on the estimator and on how far it looks.
float coverage(std::span<const Estimate> estimates, int views, const std::vector<int>& chosen);

// With less coverage, phantom views are drawn.
constexpr float kCovered = 0.75f;

}  // namespace panoptes::ambient_occlusion
