// Images as material code reads them.
#if IMAGE_COUNT > 0
#include "gpu_scene/sampling.glsl"
#endif

// The triangle's two edges in texture coordinates; false where the mesh has no UV map of that name.
bool uv_edges(Hit hit, int name, out vec2 edge1, out vec2 edge2) {
  uint word = table(hit.mesh + MESH_ATTRIBUTES + name);
  edge1 = edge2 = vec2(0.0);
  if (word == NO_ATTRIBUTE || (word & IS_COLOR) != 0u) return false;
  int i = int(word) + (hit.triangle - int(table(hit.mesh + MESH_TRIANGLE_BASE))) * 3;
  vec2 uv = texelFetch(corner_attributes, i).xy;
  edge1 = texelFetch(corner_attributes, i + 1).xy - uv;
  edge2 = texelFetch(corner_attributes, i + 2).xy - uv;
  return true;
}

// How far the texture coordinates of a UV map run across the pixel, along the narrow axis (ray cones,
// Akenine-Moller et al. 2019): what the wide axis needs at grazing angles comes from the samples of
// the pixel.
float uv_width(Hit hit, int name) {
  vec2 d1, d2;
  if (!uv_edges(hit, name, d1, d2) || !(hit.area > 0.0)) return 0.0;
  return hit.footprint * sqrt(abs(d1.x * d2.y - d1.y * d2.x) / hit.area);
}

#if IMAGE_COUNT > 0
// The level at which a texel is as wide as `width`, in texture coordinates.
float level_of(sampler2D image, float width) {
  vec2 extent = vec2(textureSize(image, 0));
  float texels = width * sqrt(extent.x * extent.y);
  return max(log2(max(texels, 1.0e-6)) + view.filtering.x, 0.0);
}
vec4 sample_image_at(sampler2D image, bool srgb, vec2 uv, float width, bool unassociate) {
  return sample_image_linear(image, srgb, uv, level_of(image, width), unassociate);
}
vec4 sample_image_cubic_at(sampler2D image, bool srgb, vec2 uv, float width, bool unassociate) {
  return sample_image_bicubic(image, srgb, uv, floor(level_of(image, width)), unassociate);
}
#define sample_image_wide(index, uv, width, unassociate) \
  sample_image_at(IMAGE(index), uv, width, unassociate)
#define sample_image_cubic(index, uv, width, unassociate) \
  sample_image_cubic_at(IMAGE(index), uv, width, unassociate)
// At coordinates of the default UV map.
#define sample_image(hit, index, uv, unassociate) \
  sample_image_wide(index, uv, uv_width(hit, UV_DEFAULT), unassociate)
#endif
