// Where a pixel's ray enters a box or leaves it: among all, the pixel's depth bounds.
#include "fragment_tracer/views.glsl"

layout(location = 0) uniform int view;
flat in uint holds_eye;
layout(std430, binding = 1) buffer Bounds { uint bounds[]; };  // bits of the least and the greatest depth

void main() {
  uint depth = floatBitsToUint(1.0 / gl_FragCoord.w);
  uint pixel = pixel_number(view, ivec2(gl_FragCoord.xy));
  // Rays begin at the eye: in a box that holds it.
  atomicMin(bounds[2u * pixel], holds_eye == 1u ? 0u : depth);
  atomicMax(bounds[2u * pixel + 1u], depth);
}
