// Light from the radiance cache at a point of a surface (thesis, section 5.3, "Irradiance
// Reconstruction"). The volumes lie relative to the origin of the points.
#include "radiance_cache/encoding.glsl"
#include "radiance_cache/volume_shared.h"

layout(std140, binding = CACHE_BLOCK) uniform CacheBlock { CacheVolumes cached; };
// The cells of all volumes: x, y, z of the volume's own, volumes one behind the other along z; then
// the same for each further texel of a cell, and along x, with CACHE_SPLIT, world and bounced light.
layout(binding = CACHE_UNIT) uniform sampler3D cells;
#if CACHE_SPLIT
#define CACHE_PARTS 2
#else
#define CACHE_PARTS 1
#endif

struct CacheLight {
  vec3 world;    // with CACHE_SPLIT: what came straight from the world; else 0
  vec3 bounced;  // with CACHE_SPLIT: what surfaces have sent on; else all
  float clipped; // what was cut off below 0, relative to the light
  float share;   // 1 within the volumes, 0 beyond their border
};

// A point as far before a surface as its cells are not to be those behind it: half a cell.
const float CACHE_OFFSET = 0.5;

// The first volume in which `position` lies at least half a cell from the border; the last one if
// there is none. `share`: 1 in it, falling to 0 over the last cell before the border of that.
int volume_of(vec3 position, out float share) {
  for (int v = 0; v < cached.count.x; ++v) {
    CacheVolume volume = cached.volumes[v];
    vec3 at = (position - volume.low.xyz) / volume.low.w;
    vec3 margin = min(at, vec3(volume.cells.xyz) - at);
    float least = min(margin.x, min(margin.y, margin.z));
    share = clamp(least, 0.0, 1.0);
    if (least >= 1.0) return v;
  }
  return cached.count.x - 1;
}

vec4[CELL_TEXELS] fetch_cell(int v, vec3 position, int part) {
  CacheVolume volume = cached.volumes[v];
  vec3 at = clamp((position - volume.low.xyz) / volume.low.w, vec3(0.5),
                  vec3(volume.cells.xyz) - 0.5);
  vec3 size = vec3(textureSize(cells, 0));
  at.x += float(part) * size.x / float(CACHE_PARTS);
  at.z += float(volume.first.w);
  vec4 texels[CELL_TEXELS];
  for (int k = 0; k < CELL_TEXELS; ++k)
    texels[k] = textureLod(cells, vec3(at.xy, at.z + float(k * cached.count.w)) / size, 0.0);
  return texels;
}

// Light at `position` on a surface that faces `normal`, by `weights` of the harmonics.
CacheLight cache_light(vec3 position, vec3 normal, float weights[9]) {
  float share;
  int v = volume_of(position, share);
  vec3 before = position + normal * (CACHE_OFFSET * cached.volumes[v].low.w);
  CacheLight light;
#if CACHE_SPLIT
  vec3 world = decode(fetch_cell(v, before, 0), weights).rgb;
  vec3 bounced = decode(fetch_cell(v, before, 1), weights).rgb;
#else
  vec3 world = vec3(0.0);
  vec3 bounced = decode(fetch_cell(v, before, 0), weights).rgb;
#endif
  light.world = max(world, vec3(0.0));
  light.bounced = max(bounced, vec3(0.0));
  vec3 cut = light.world - world + light.bounced - bounced;
  vec3 all = light.world + light.bounced;
  light.share = share;
  light.clipped = (cut.r + cut.g + cut.b) / max(all.r + all.g + all.b, 1.0e-20);
  return light;
}
