// What reaches a voxel: a bit for each of the 27 cells about the one that it lies in, set where no solid
// voxel stands between the cell's seed and the voxel's middle; none for solid voxels. Only cells that a
// look-up at the voxel can go to are told of.
uint reach_bit(ivec3 step) { return 1u << uint(step.x + 1 + 3 * (step.y + 1 + 3 * (step.z + 1))); }
