// The geometry volume: which voxels are solid and what surface lies in them. A program defines where
// its parts are bound: VOLUMES_BLOCK, the uniform block, and the texture units VOLUME_WORDS_UNIT and,
// if it reads surfels, VOLUME_SURFELS_UNIT.
#include "base/packing.glsl"
#include "radiance_cache/volume_shared.h"

layout(std140, binding = VOLUMES_BLOCK) uniform VolumesBlock { CacheVolumes cache; };
// A word stands for 32 voxels along x. x: bit i is set where the i-th of them is solid; y: solid voxels
// in all words before.
layout(binding = VOLUME_WORDS_UNIT) uniform usamplerBuffer volume_words;

float voxel_size(CacheVolume volume) { return volume.low.w / float(volume.cells.w); }

ivec3 voxel_counts(CacheVolume volume) { return volume.cells.xyz * volume.cells.w; }

// The voxel that holds `position`, which may lie outside: then near the volume.
ivec3 voxel_of(CacheVolume volume, vec3 position) {
  vec3 at = (position - volume.low.xyz) / voxel_size(volume);
  return ivec3(floor(clamp(at, vec3(-1.0), vec3(voxel_counts(volume)))));
}

bool holds_voxel(CacheVolume volume, ivec3 voxel) {
  return all(greaterThanEqual(voxel, ivec3(0))) && all(lessThan(voxel, voxel_counts(volume)));
}

// The word of a voxel that the volume holds; bit voxel.x & 31 is its own.
int word_of(CacheVolume volume, ivec3 voxel) {
  return volume.first.y +
         (voxel.z * volume.cells.y * volume.cells.w + voxel.y) * volume.first.x + (voxel.x >> 5);
}

// The volume that a word is of, and the first of its voxels.
int volume_of_word(int word) {
  int found = 0;
  for (int v = 1; v < cache.count.x; ++v)
    if (word >= cache.volumes[v].first.y) found = v;
  return found;
}

ivec3 voxel_of_word(CacheVolume volume, int word) {
  int place = word - volume.first.y, row = place / volume.first.x, rows = volume.cells.y * volume.cells.w;
  return ivec3((place - row * volume.first.x) * 32, row % rows, row / rows);
}

bool voxel_is_solid(CacheVolume volume, ivec3 voxel) {
  return (texelFetch(volume_words, word_of(volume, voxel)).x >> uint(voxel.x & 31) & 1u) != 0u;
}

// The number of a solid voxel among the bits of its word and all before.
uint solid_number(uvec2 word, uint bit) { return word.y + uint(bitCount(word.x & ((1u << bit) - 1u))); }

// The surfel of a solid voxel.
uint surfel_of(CacheVolume volume, ivec3 voxel) {
  return solid_number(texelFetch(volume_words, word_of(volume, voxel)).xy, uint(voxel.x & 31));
}

#ifdef VOLUME_SURFELS_UNIT
layout(binding = VOLUME_SURFELS_UNIT) uniform usamplerBuffer volume_surfels;  // as Surfel

Surfel fetch_surfel(uint number) {
  int texel = int(number) * 2;
  return Surfel(uintBitsToFloat(texelFetch(volume_surfels, texel)),
                texelFetch(volume_surfels, texel + 1));
}
#endif
