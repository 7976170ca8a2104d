// Light of cells between that of the frame before and this frame's (thesis, section 5.3, "Temporal
// Blending"). One invocation a cell. The thesis keeps the same share of all cells, so that light which
// changes lags behind; here a cell whose light has changed by more than flicker does takes the new.
#include "base/invocation.glsl"
#include "radiance_cache/cells.glsl"
#include "radiance_cache/encoding.glsl"
#include "radiance_cache/parts.glsl"

#define TEXELS (CACHE_PARTS * CELL_TEXELS)

layout(local_size_x = 64) in;
layout(std140, binding = CACHE_BLOCK) uniform CacheBlock { CacheVolumes cached; };
layout(std430, binding = 0) readonly buffer List { uint active_cells[]; };
layout(std430, binding = 1) writeonly buffer Shown { vec4 shown[]; };  // holds this frame's
layout(binding = 0) uniform samplerBuffer cells;     // this frame's; look_up.glsl
layout(binding = 1) uniform samplerBuffer previous;  // what was shown before
layout(location = 0) uniform uint active_count;
layout(location = 1) uniform float share;            // of the frame before
layout(location = 2) uniform ivec4 moved[MOST_CASCADES];  // xyz: from cells now to cells before; w: number of its first
layout(location = 2 + MOST_CASCADES) uniform ivec4 before[MOST_CASCADES];  // xyz: cells along each axis

// Changes of a cell's light, relative to it: up to the first it is flicker, from the second on another light.
const float FLICKER = 0.05, CHANGE = 0.15;

void main() {
  uint slot = invocation();
  if (slot >= active_count) return;
  uint number = active_cells[slot];
  Cell cell = cell_of(cached, number);
  ivec3 at = cell.at + moved[cell.volume].xyz, count = before[cell.volume].xyz;
  if (any(lessThan(at, ivec3(0))) || any(greaterThanEqual(at, count))) return;
  int first = int(number) * TEXELS;
  int old = (moved[cell.volume].w + (at.z * count.y + at.y) * count.x + at.x) * TEXELS;
  // A cell that looks from elsewhere may have come to the other side of a wall.
  const int last = CELL_TEXELS - 1, component = COEFFICIENTS % 4;
  if (texelFetch(cells, first + last)[component] != texelFetch(previous, old + last)[component]) return;

  float difference = 0.0, now = 0.0, then = 0.0;
  for (int k = 0; k < TEXELS; ++k) {
    vec4 mine = texelFetch(cells, first + k), other = texelFetch(previous, old + k);
    if (k % CELL_TEXELS == last) mine[component] = other[component] = 0.0;
    difference += dot(mine - other, mine - other);
    now += dot(mine, mine);
    then += dot(other, other);
  }
  float change = sqrt(difference / max(max(now, then), 1.0e-30));
  float keep = share * (1.0 - smoothstep(FLICKER, CHANGE, change));
  if (!(keep > 0.0)) return;
  for (int k = 0; k < TEXELS; ++k)
    shown[first + k] = mix(texelFetch(cells, first + k), texelFetch(previous, old + k), keep);
}
