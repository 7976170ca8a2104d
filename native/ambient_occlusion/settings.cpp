#include "ambient_occlusion/settings.h"

#include "base/choices.h"
#include "base/error.h"

#include <algorithm>
#include <cmath>

namespace panoptes::ambient_occlusion {

namespace {

// Samples a pixel of contact(). More change no picture that was looked at: of an atrium and a box, the
// error stays the same to a thousandth.
constexpr int kContactSamples = 8, kInitialContactSamples = 3;

void check_range(int value, int least, int most, const char* what) {
  if (value < least || value > most)
    fail("{} {} of ambient occlusion are out of range: choose {} to {}", value, what, least, most);
}

}  // namespace

void Settings::check() const {
  check_choice(kEstimatorNames, estimator, "estimator of ambient occlusion");
  check_choice(kPhantomsNames, phantoms, "mode of phantom views");
  check_choice(kFilterNames, filter, "mode of the occlusion filter");
  check_choice(kPictureNames, picture, "picture of ambient occlusion");
  if (!(distance > 0) || !std::isfinite(distance))
    fail("a distance of {} m for ambient occlusion is out of range: choose more than 0", distance);
  if (!(strength >= 0 && strength <= 1) || !(deep_shadows >= 0 && deep_shadows <= 1))
    fail("strengths of ambient occlusion and deep shadows must lie in 0 to 1: set them again");
  check_range(samples, 1, 256, "samples");
  check_range(initial_samples, 1, 256, "initial samples");
  check_range(secondary_views, 0, kMostSecondaryViews, "secondary views");
  check_range(phantom_resolution, 16, 4096, "texels of phantom views");
  check_range(phantom_camera_count, 0, kMostPhantomCameras, "phantom cameras");
  for (int i = 0; i < phantom_camera_count; ++i) {
    gpu_scene::Camera camera = phantom_cameras[size_t(i)];
    camera.width = camera.height = 1;  // their size is not read
    try {
      camera.check(1);
    } catch (const Error& error) {
      fail("phantom camera {} cannot be used, since {}", i + 1, error.what());
    }
  }
}

Settings contact(const Settings& settings, double reach) {
  Settings found = settings;
  found.distance = float(std::min(double(settings.distance), reach));
  found.samples = std::min(settings.samples, kContactSamples);
  found.initial_samples = std::min(settings.initial_samples, kInitialContactSamples);
  found.secondary_views = 0;
  if (found.phantoms == Phantoms::kAuto && found.phantom_camera_count == 0) found.phantoms = Phantoms::kOff;
  return found;
}

}  // namespace panoptes::ambient_occlusion
