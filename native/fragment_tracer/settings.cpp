#include "fragment_tracer/settings.h"

#include "base/error.h"

namespace panoptes::fragment_tracer {

void Settings::check() const {
  if (int(storage) < 0 || size_t(storage) >= kStorageNames.size() || int(walk) < 0 ||
      size_t(walk) >= kWalkNames.size() || int(views) < 0 || size_t(views) >= kViewsNames.size())
    fail("the structure of fragments has no such storage, walk or views: please report it");
  if (side < 1 || side > 4096) fail("{} pixels a side of the cube were asked for: choose 1 to 4096", side);
  if (camera_width < 0 || camera_width > 16384)
    fail("{} pixels across the camera's view were asked for: choose 1 to 16384, or 0 for the picture's", camera_width);
  if (buckets < 1 || buckets > 64) fail("{} buckets of a pixel were asked for: choose 1 to 64", buckets);
  if (int(bounds) < 0 || size_t(bounds) >= kBoundsNames.size())
    fail("the structure of fragments has no such bounds of depth: please report it");
  if (layers < 0 || layers > 256) fail("{} layers were asked for: choose 1 to 256, or 0 for all", layers);
  if (layers > 0 && has_buckets(storage))
    fail("only storages without buckets keep a number of layers: choose SB, LL or DLL, or 0 layers for all");
  if (steps < 1 || steps > 4096) fail("{} steps across a view were asked for: choose 1 to 4096", steps);
  if (!(thickness >= 0 && thickness <= 1)) fail("a thickness of {} was asked for: choose 0 to 1", thickness);
}

}  // namespace panoptes::fragment_tracer
