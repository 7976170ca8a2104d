// Marks the cells that look-ups at what the camera sees read (thesis, section 5.5, "Depth-based
// Occupancy"), at one pixel in a square of them. One invocation a square.
#define G_BUFFER_READ 1
#include "base/invocation.glsl"
#include "radiance_cache/touched_cells.glsl"
#include "rasterize/g_buffer.glsl"

layout(local_size_x = 64) in;
layout(binding = DEPTH_UNIT) uniform sampler2D depth;  // 0 where no surface is
layout(std430, binding = 0) buffer Seeds { uint seeds[]; };
layout(std430, binding = 1) buffer Counter { uint unlit; };  // cells that are seen and not listed
layout(location = 0) uniform ivec3 squares;  // across, up, pixels a side
layout(location = 1) uniform bool behind;    // surfaces let light in from behind, too

void mark(vec3 position, vec3 normal) {
  float share;
  CacheVolume volume = cached.volumes[volume_of(position, share)];
  vec3 fraction;
  ivec3 corner = lowest_cell(volume, (position - volume.low.xyz) / volume.low.w, normal, fraction);
  for (int i = 0; i < 8; ++i) {
    ivec3 cell = min(corner + ivec3(i & 1, i >> 1 & 1, i >> 2), volume.cells.xyz - 1);
    int number = cell_number(volume, cell);
    // Neighbours see the same cells.
    if ((seeds[number] & CELL_SEEN) != 0u) continue;
    uint seed = atomicOr(seeds[number], CELL_SEEN);
    bool holds_light = (seed & CELL_LISTED) != 0u || (seed & SEED_CODE) == 0u;
    if ((seed & CELL_SEEN) == 0u && !holds_light) atomicAdd(unlit, 1u);
  }
}

void main() {
  int square = int(invocation());
  if (square >= squares.x * squares.y) return;
  ivec2 pixel = ivec2(square % squares.x, square / squares.x) * squares.z + squares.z / 2;
  pixel = min(pixel, textureSize(depth, 0) - 1);
  if (texelFetch(depth, pixel, 0).x <= 0.0) return;
  vec3 position = texelFetch(g_position, pixel, 0).xyz;
  vec3 normal = unpack_unit(texelFetch(g_normals, pixel, 0).z);
  mark(position, normal);
  if (behind) mark(position, -normal);
}
