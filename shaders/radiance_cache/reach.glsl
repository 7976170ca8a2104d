// What reaches a voxel: a bit for each of the 27 cells about the one that it lies in, set where no solid
// voxel stands between the cell's seed and the voxel's middle; none for solid voxels. Only cells that a
// look-up at the voxel can go to are told of.
uint reach_bit(ivec3 step) { return 1u << uint(step.x + 1 + 3 * (step.y + 1 + 3 * (step.z + 1))); }

// The bits of all cells in the box from the middle one to that at `step`, whose components are -1, 0 or 1.
uint reach_bits_between(ivec3 step) {
  uvec3 along = uvec3(step.x < 0 ? 3u : step.x > 0 ? 6u : 2u, step.y < 0 ? 9u : step.y > 0 ? 72u : 8u,
                      step.z < 0 ? 513u : step.z > 0 ? 262656u : 512u);
  return along.x * along.y * along.z;  // each a sum of powers of 2, 8 or 512
}
