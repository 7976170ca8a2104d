// Which cells a look-up at a point of a surface reads.
#include "radiance_cache/cells.glsl"

layout(std140, binding = CACHE_BLOCK) uniform CacheBlock { CacheVolumes cached; };

// A point as far before a surface, in cells, sees what the surface sees and is nearer to cells before it.
const float CACHE_OFFSET = 0.5;

// The first volume in which `position` lies at least a cell from the border; the last one if there is
// none. `share`: 1, but if that does not hold all of the scene it falls to 0 over its last cell.
int volume_of(vec3 position, out float share) {
  for (int v = 0; v < cached.count.x; ++v) {
    CacheVolume volume = cached.volumes[v];
    vec3 at = (position - volume.low.xyz) / volume.low.w;
    vec3 margin = min(at, vec3(volume.cells.xyz) - at);
    float least = min(margin.x, min(margin.y, margin.z));
    share = clamp(least, 0.0, 1.0);
    if (least >= 1.0) return v;
  }
  if (cached.count.w != 0) share = 1.0;
  return cached.count.x - 1;
}

// The lowest of the eight cells between which a look-up interpolates, and how far it lies from there to
// the highest. `place`: in cells, from the volume's lowest corner.
ivec3 lowest_cell(CacheVolume volume, vec3 place, vec3 normal, out vec3 fraction) {
  vec3 at = clamp(place + normal * CACHE_OFFSET, vec3(0.5), vec3(volume.cells.xyz) - 0.5) - 0.5;
  ivec3 corner = ivec3(at);
  fraction = at - vec3(corner);
  return corner;
}
