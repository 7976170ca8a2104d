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
  // A threshold uniform over samples and pixels makes the mean over samples the exact coverage; a
  // single sample has one threshold for all pixels, since a clean edge beats noise.
  float threshold = view.alpha.x;
  if (view.alpha.y < 0.5) {
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    threshold = fract(threshold + unit_float(hash(pixel.x + hash(pixel.y + hash(triangle)))));
  }
  if (1.0 - luminance(surface.transparency) <= threshold) discard;
#endif
#if !DEPTH_ONLY
  visible = uvec2(drawn.x, triangle);
#endif
}
