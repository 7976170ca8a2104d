// A triangle that may be drawn for a voxel.
struct Contender {
  uint voxel;  // word * 32 + bit
  uint key;    // bits of a positive number: the greatest wins
  uint primitive;
};
