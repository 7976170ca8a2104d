// What an artist may choose of multiview ambient occlusion (thesis, chapter 4).
#pragma once

#include "ambient_occlusion/names.h"
#include "gpu_scene/view.h"

#include <array>

namespace panoptes::ambient_occlusion {

// More than these would cost more than they show (section 4.4.5), and each is drawn and looked at.
constexpr int kMostPhantomCameras = 4;
constexpr int kMostSecondaryViews = 8;

// Samples of HBAO: directions around a point and steps in each (section 4.4.3, Figure 4.7).
constexpr int kHbaoSlices = 6, kHbaoSteps = 4;

struct Settings {
  Estimator estimator = Estimator::kAlchemy;
  float distance = 10;  // m, r_max: how far occluders are looked for; above 0, finite
  float strength = 1;   // 0 .. 1, of what it takes from the world's light; the AO pass has all of it
  int samples = 15;     // a view and pixel, N_s of (4.3); HBAO has 24 whatever is asked for
  // With it, `initial_samples` of them are a first estimate by which the rest are dealt out, (4.5).
  bool importance_sampling = true;
  int initial_samples = 5;
  // Shadow maps of lamps that are looked at as well: those with the largest incremental
  // contribution, at most so many. 0: none.
  int secondary_views = 2;
  Phantoms phantoms = Phantoms::kAuto;
  int phantom_resolution = 256;  // texels a side
  // Cameras that the artist chose take the pair's place: the first `phantom_camera_count`. Their size
  // is not read: they have phantom_resolution along their longer side.
  int phantom_camera_count = 0;
  std::array<gpu_scene::Camera, kMostPhantomCameras> phantom_cameras;
  Filter filter = Filter::kAuto;
  // Volumetric obscurance by the lamps' maps darkens the world's light further where lamps are
  // blocked, 0 .. 1: a look, not physics (section 4.4.3.2).
  float deep_shadows = 0;
  Picture picture = Picture::kNone;

  // Throws Error with a sentence when a value is out of range.
  void check() const;
};

// Occlusion that only adds what rays of the radiance cache cannot meet, since it stands nearer than
// `reach` metres. The camera alone sees enough of that, by few samples, unless phantom views are asked for.
Settings contact(const Settings& settings, double reach);

}  // namespace panoptes::ambient_occlusion
