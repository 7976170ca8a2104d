// Directions by the brightness of the world: a map of latitudes and longitudes as cumulative
// probabilities, first of the rows, then of the texels of each row.
#include "path_tracer/lights_shared.h"

layout(binding = 3) uniform samplerBuffer world_map;  // height + 1 values, then width + 1 a row

const float WORLD_PI = 3.14159265359;

// The last of `count` steps that begins at `random` or before; they begin at texel `base`.
int find_step(int base, int count, float random) {
  int low = 0, high = count - 1;
  while (low < high) {
    int middle = (low + high + 1) / 2;
    if (texelFetch(world_map, base + middle).x <= random) low = middle;
    else high = middle - 1;
  }
  return low;
}

// Where `random` falls into step `i`, and the step's probability.
vec2 place_in_step(int base, int i, float random) {
  float begin = texelFetch(world_map, base + i).x;
  float probability = texelFetch(world_map, base + i + 1).x - begin;
  return vec2(clamp((random - begin) / probability, 0.0, 1.0), probability);
}

// A direction and its density per solid angle. Within a texel all angles are alike.
vec3 sample_world_map(ivec2 size, vec2 random, out float pdf) {
  int row = find_step(0, size.y, random.y);
  vec2 down = place_in_step(0, row, random.y);
  int base = size.y + 1 + row * (size.x + 1);
  int column = find_step(base, size.x, random.x);
  vec2 across = place_in_step(base, column, random.x);
  float phi = (float(column) + across.x) / float(size.x) * 2.0 * WORLD_PI;
  float theta = (float(row) + down.x) / float(size.y) * WORLD_PI;
  float sine = sin(theta);
  pdf = sine > 0.0 ? down.y * across.y * float(size.x * size.y) / (2.0 * WORLD_PI * WORLD_PI * sine) : 0.0;
  return vec3(sine * cos(phi), sine * sin(phi), cos(theta));
}

float world_map_pdf(ivec2 size, vec3 direction) {
  float sine = length(direction.xy);
  float phi = atan(direction.y, direction.x);
  if (phi < 0.0) phi += 2.0 * WORLD_PI;
  float theta = atan(sine, direction.z);
  int column = min(int(phi / (2.0 * WORLD_PI) * float(size.x)), size.x - 1);
  int row = min(int(theta / WORLD_PI * float(size.y)), size.y - 1);
  float down = place_in_step(0, row, 0.0).y;
  float across = place_in_step(size.y + 1 + row * (size.x + 1), column, 0.0).y;
  return sine > 0.0 ? down * across * float(size.x * size.y) / (2.0 * WORLD_PI * WORLD_PI * sine) : 0.0;
}
