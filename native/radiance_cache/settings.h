// What an artist may choose of the radiance cache (thesis, chapter 5).
#pragma once

#include "radiance_cache/names.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>

namespace panoptes::radiance_cache {

constexpr int kMostRegions = 8;
constexpr int kMostBounces = 8, kMostCascades = 3;

// A box in which the cache's light is scaled.
struct Region {
  glm::dmat4 world_to_box{1.0};  // the box is [-1, 1]^3
  float luminance = 1, chrominance = 1;
  bool operator==(const Region&) const = default;
};

// How many cells hold light, of all that there are.
struct Occupied {
  int64_t cells = 0, lattice = 0;
  int64_t fewer = 0;  // of these, those that look in fewer directions since nobody sees them
};

struct Settings {
  bool enabled = true;
  int bounces = 2;     // 0 .. kMostBounces; 0: the world's light alone
  int resolution = 0;  // cells along the longest side, 4 .. 64; 0: chosen from scene and view
  int voxels = 4;      // of the geometry volume along a cell's side, 2 .. 8 (section 5.5: 4)
  // Cascades of the same resolution, each twice as wide as the one in it, the first about the
  // camera; 1: the whole scene in one; 0: as many as scene and view call for.
  int cascades = 0;
  // The least that keeps apart the colours of walls that face each other: the thesis' Y3Co1Cg1 has nearly
  // four times the error in a room of coloured walls, and saves a fiftieth of the time.
  Encoding encoding = Encoding::kY3Co2Cg2;
  // Of the cache's light, at least 0; 1: as it is (section 5.4).
  float luminance = 1, chrominance = 1;
  int region_count = 0;
  std::array<Region, kMostRegions> regions;

  FirstBounce first_bounce = FirstBounce::kSurfaces;
  int directions = 64;   // marched from each cell, n_sec, 8 .. 512
  // Of all cells together, above 0; as many as a buffer texture holds on every driver. Where they
  // would be more, cells look in fewer directions.
  int64_t most_rays = int64_t(1) << 26;
  int march_steps = 0;   // jittered samples along a ray, 0 .. 256; 0: every voxel that it passes
  float voxel_fill = 0.75f;  // area of surface that makes a voxel solid, in faces of it, 0 .. 1
  Occupancy occupancy = Occupancy::kAuto;
  int depth_stride = 4;  // pixels between those that mark cells as seen, 1 .. 64
  // Neighbours of occupied cells hold light too. Without, surfaces with their own cell behind them
  // have none to look at.
  bool dilate = true;
  // Light does not pass walls that are thinner than a cell: cells count for what their seeds see. False
  // as the thesis has it, whose cells light both sides.
  bool walls = true;

  // Of reflective shadow maps, the thesis' first bounce. Surfaces that rays meet give the same light on
  // average: 64 directions are smoother than 1000 samples of a lamp, take less time, and as long for many
  // lamps as for one. The maps are there to be compared with.
  int rsm_samples = 200;     // a lamp and cell, 1 .. 4096; less than 1000 leave blotches
  int rsm_resolution = 128;  // texels a side, 16 .. 1024
  // s of (5.3), above 0, at most 1. Light comes in bright from what is near, so that a narrow window has
  // half the noise of the thesis' .8, while the rest of the map is not lost.
  float rsm_spread = 0.25f;
  // Half of the samples come from the whole map, by the balance heuristic. Without, as in the thesis,
  // what lies outside the window gives no light.
  bool rsm_mixed = true;

  // Of frames that follow each other in a 3D View, whose picture refines to what it is without.
  // Share of the light shown before, 0 .. .98, where that has hardly changed.
  float blend = 0.8f;
  int rebuild_every = 1;  // frames, 1 .. 16: while geometry moves, the volume lags behind by less

  Picture picture = Picture::kNone;

  // Throws Error with a sentence when a value is out of range.
  void check() const;
  bool operator==(const Settings&) const = default;
};

}  // namespace panoptes::radiance_cache
