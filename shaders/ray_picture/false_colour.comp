// Adds the colours of what rays cost to the film, for a run of pixels (ray_picture.h has the scale).
#include "base/invocation.glsl"
#include "base/packing.glsl"
#include "film/film.glsl"
#include "gpu_scene/view_shared.h"
#include "tracing/rays_shared.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Work { TracedWork works[]; };
layout(location = 0) uniform uvec2 range;  // of pixels, in rows: first, count

// Colours by the power of four that 1 + n is.
const vec3 SCALE[7] = vec3[](vec3(0.0), vec3(0.0, 0.0, 1.0), vec3(0.0, 1.0, 1.0),
                             vec3(0.0, 1.0, 0.0), vec3(1.0, 1.0, 0.0), vec3(1.0, 0.0, 0.0),
                             vec3(1.0));

vec3 colour_of_number(uint n) {
  float power = clamp(0.5 * log2(1.0 + float(n)), 0.0, 6.0);
  int below = min(int(power), 5);
  return mix(SCALE[below], SCALE[below + 1], power - float(below));
}

vec3 colour_of_cell(uint cell) {
  uint bits = hash(cell);
  return 0.1 + 0.9 * vec3(bits & 255u, bits >> 8u & 255u, bits >> 16u & 255u) / 255.0;
}

// KIND is a ray_picture::Kind.
vec3 colour_of(TracedWork work) {
#if KIND == 1
  return colour_of_number(work.steps);
#elif KIND == 2
  return colour_of_number(work.tests);
#elif KIND == 3
  return colour_of_number(work.longest);
#else
  return work.longest > 0u ? colour_of_cell(work.cell) : vec3(0.0);
#endif
}

void main() {
  uint slot = invocation();
  if (slot >= range.y) return;
  uint pixel = range.x + slot;
  uint width = uint(view.size.x);
  film_add(FILM_COMBINED, ivec2(pixel % width, pixel / width), vec4(colour_of(works[slot]), 1.0));
}
