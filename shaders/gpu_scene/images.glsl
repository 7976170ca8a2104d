// Images as material code reads them.

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

// How far texture coordinates run along one metre of the surface.
float uv_per_metre(Hit hit) {
  vec2 d1, d2;
  if (!uv_edges(hit, UV_DEFAULT, d1, d2) || !(hit.area > 0.0)) return 0.0;
  return sqrt(abs(d1.x * d2.y - d1.y * d2.x) / hit.area);
}

// Codes are filtered as they are and linearised afterwards, as Cycles does with 8-bit images.
// The texture level from the pixel's footprint (ray cones, Akenine-Moller et al. 2019), along the
// narrow axis: what the wide axis needs at grazing angles comes from the samples of the pixel.
vec4 sample_image_at(sampler2D image, bool srgb, Hit hit, vec2 uv, bool unassociate) {
  vec2 extent = vec2(textureSize(image, 0));
  float texels = hit.footprint * uv_per_metre(hit) * sqrt(extent.x * extent.y);
  vec4 color = textureLod(image, uv, max(log2(max(texels, 1.0e-6)) + view.filtering.x, 0.0));
  if (unassociate && color.a > 0.0) color.rgb /= color.a;
  if (srgb) color.rgb = linear_from_srgb(color.rgb);
  return color;
}
// Images beyond what the driver allows share the last unit, which shows a missing one.
#define sample_image(hit, index, uv, unassociate)                                              \
  sample_image_at(material_images[min(index, IMAGE_COUNT - 1)],                                \
                  ((material_block.z >> min(index, IMAGE_COUNT - 1)) & 1u) != 0u, hit, uv,     \
                  unassociate)
