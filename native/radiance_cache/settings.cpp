#include "radiance_cache/settings.h"

#include "base/choices.h"
#include "base/error.h"

#include <cmath>

namespace panoptes::radiance_cache {

namespace {

void check_range(int value, int least, int most, const char* what) {
  if (value < least || value > most)
    fail("{} {} of the radiance cache are out of range: choose {} to {}", value, what, least, most);
}

void check_scale(float value, const char* what) {
  if (!(value >= 0) || !std::isfinite(value))
    fail("a scale of {} for the {} of indirect light is out of range: choose 0 or more", value, what);
}

void check_scales(float luminance, float chrominance) {
  check_scale(luminance, "luminance");
  check_scale(chrominance, "chrominance");
}

}  // namespace

void Settings::check() const {
  check_choice(kEncodingNames, encoding, "encoding of the radiance cache");
  check_choice(kFirstBounceNames, first_bounce, "kind of first bounce");
  check_choice(kOccupancyNames, occupancy, "occupancy of the radiance cache");
  check_choice(kPictureNames, picture, "picture of the radiance cache");
  check_range(bounces, 0, kMostBounces, "bounces");
  if (resolution != 0) check_range(resolution, 4, 64, "cells");
  check_range(voxels, 2, 8, "voxels a cell");
  check_range(cascades, 0, kMostCascades, "cascades");
  check_range(directions, 8, 512, "directions");
  check_range(march_steps, 0, 256, "steps a ray");
  check_range(depth_stride, 1, 64, "pixels of stride");
  check_range(rsm_samples, 1, 4096, "samples of a reflective shadow map");
  check_range(rsm_resolution, 16, 1024, "texels of a reflective shadow map");
  check_range(rebuild_every, 1, 16, "frames between rebuilds of the geometry volume");
  check_range(region_count, 0, kMostRegions, "regions");
  if (!(voxel_fill >= 0 && voxel_fill <= 1))
    fail("a voxel cannot be solid from {} of its face on: choose 0 to 1", voxel_fill);
  if (!(rsm_spread > 0 && rsm_spread <= 1))
    fail("a spread of {} for reflective shadow maps is out of range: choose above 0 to 1", rsm_spread);
  if (!(blend >= 0 && blend <= 0.98f))
    fail("a share of {} of the frame before is out of range: choose 0 to .98", blend);
  check_scales(luminance, chrominance);
  for (int i = 0; i < region_count; ++i)
    check_scales(regions[size_t(i)].luminance, regions[size_t(i)].chrominance);
}

}  // namespace panoptes::radiance_cache
