// Where the radiance cache's cells and the voxels of its geometry volume lie.
//
// A volume is a box of cubic cells; each cell is `voxels`^3 voxels of the geometry volume. Up to
// MOST_CASCADES volumes lie in each other, the finest first.
#pragma once

#include "base/cpp_glsl.h"

SHARED_BEGIN

struct CacheVolume {
  vec4 low;     // xyz: lowest corner, m, relative to the origin of positions; w: a cell's side, m
  ivec4 cells;  // xyz: cells along each axis; w: voxels along a cell's side
  ivec4 first;  // x: words of a row of voxels along x, 32 voxels each; y: the first word of this
                // volume; z: its first cell, in the numbers of all volumes' cells
};
SHARED_ASSERT_SIZE(CacheVolume, 48)

#define MOST_CASCADES 3

struct CacheVolumes {
  CacheVolume volumes[MOST_CASCADES];
  ivec4 count;  // x: volumes; y: cells of all; z: solid voxels of all; w: 1: the last volume holds
                // all of the scene
};
SHARED_ASSERT_SIZE(CacheVolumes, 48 * MOST_CASCADES + 16)

// A solid voxel stands for the surfaces in it by one point of them, its surfel. Solid voxels are
// numbered in the order of words and bits, volume by volume.
struct Surfel {
  vec4 place;    // xyz: position, m, relative to the list of triangles' origin; w: area of surface in
                 // the voxel, m^2
  uvec4 surface; // x: pack_unit(geometric normal of the front); y, z: pack_color(what is reflected to
                 // the front and to the back); w: place of the instance on the GPU
};
SHARED_ASSERT_SIZE(Surfel, 32)

SHARED_END
