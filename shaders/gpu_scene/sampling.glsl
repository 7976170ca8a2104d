// Reading images: what materials and worlds share. The includer declares `material_images` and
// `material_block`. Codes are filtered as they are and linearised afterwards, as Cycles does with
// 8-bit images; with `unassociate` the colour is divided by alpha.

vec4 decode_texel(vec4 color, bool srgb, bool unassociate) {
  if (unassociate && color.a > 0.0) color.rgb /= color.a;
  if (srgb) color.rgb = linear_from_srgb(color.rgb);
  return color;
}

vec4 sample_image_linear(sampler2D image, bool srgb, vec2 uv, float lod, bool unassociate) {
  return decode_texel(textureLod(image, uv, lod), srgb, unassociate);
}

// A uniform cubic B-spline over 4 x 4 texels, by four reads between texels (Sigg and Hadwiger 2005).
vec4 sample_image_bicubic(sampler2D image, bool srgb, vec2 uv, float lod, bool unassociate) {
  vec2 size = vec2(textureSize(image, int(lod)));
  vec2 place = uv * size - 0.5;
  vec2 f = fract(place), rest = 1.0 - f;
  place -= f;
  vec2 outer = f * f * f / 6.0;
  vec2 low = rest * rest * rest / 6.0 + (2.0 / 3.0 - 0.5 * f * f * (2.0 - f));
  vec2 high = 1.0 - low;
  vec2 before = (place - 0.5 + (2.0 / 3.0 - 0.5 * f * f * (2.0 - f)) / low) / size;
  vec2 after = (place + 1.5 + outer / high) / size;
  vec4 color = low.y * (low.x * textureLod(image, before, lod) +
                        high.x * textureLod(image, vec2(after.x, before.y), lod)) +
               high.y * (low.x * textureLod(image, vec2(before.x, after.y), lod) +
                         high.x * textureLod(image, after, lod));
  return decode_texel(color, srgb, unassociate);
}

// An image and whether it holds sRGB codes, as two arguments. Images beyond what the driver allows
// share the last unit, which shows a missing one.
#define IMAGE(index)                              \
  material_images[min(index, IMAGE_COUNT - 1)],   \
      ((material_block.z >> min(index, IMAGE_COUNT - 1)) & 1u) != 0u
