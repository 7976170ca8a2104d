// Writes which triangle is seen (camera) or nothing but depth (shadow maps). With ALPHA the
// material decides whether this sample of the pixel sees the surface at all.
#if ALPHA
#include "gpu_scene/material.glsl"
#include "generated/material.glsl"
#endif

flat in uvec4 drawn;
#if !DEPTH_ONLY
layout(location = 0) out uvec2 visible;  // x: draw record + 1; y: triangle in the mesh
#endif

void main() {
  uint triangle = drawn.z + uint(gl_PrimitiveID);
#if ALPHA
  Hit hit = fetch_hit(view_ray(gl_FragCoord.xy), drawn.y, triangle);
  Surface surface = empty_surface();
  evaluate_material(hit, surface);
  // A threshold that is uniform over the samples makes their mean the exact coverage; layers and
  // views have thresholds of their own, so that what passes several is the product of all. A single
  // sample has one threshold for all pixels, since a clean edge beats noise.
  float threshold = view.alpha.x;
  if (threshold < 0.0) {
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    uint layer = hash(triangle + hash(fetch_seed(drawn.y) + hash(uint(view.size.w) + floatBitsToUint(view.alpha.y))));
    threshold = unit_float(shuffled_radical_inverse(uint(view.size.z),
                                                    hash(pixel.x + hash(pixel.y + layer))));
  }
  if (1.0 - luminance(surface.transparency) <= threshold) discard;
#endif
#if !DEPTH_ONLY
  visible = uvec2(drawn.x, triangle);
#endif
}
