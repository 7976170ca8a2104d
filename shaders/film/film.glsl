// Sums of a block of samples, one layer a pass. A pass that is not asked for has no layer: its FILM_*
// is not defined, and the adding is not compiled. Depth and Position are added to in the first sample
// alone; the moments of brightness follow from Combined by themselves.
// Reads go through a sampler: on llvmpipe they are several times faster than image loads.
layout(binding = 7, rgba32f) writeonly uniform image2DArray film;
layout(binding = 8) uniform sampler2DArray film_sums;
layout(std430, binding = 15) buffer FilmSpoiled { uint film_spoiled; };

// By their bits, since compilers may take for granted that there are only numbers.
bvec4 film_unusable(vec4 value) {
  return equal(floatBitsToUint(value) & 0x7f800000u, uvec4(0x7f800000u));
}

void film_sum(int layer, ivec2 pixel, vec4 value) {
  ivec3 place = ivec3(pixel, layer);
  vec4 sum = texelFetch(film_sums, place, 0) + value;
  // Devices differ in whether they know numbers below the least normal one (film/sample_sums.h).
  imageStore(film, place, mix(sum, vec4(0.0), lessThan(abs(sum), vec4(1.17549435e-38))));
}

// Infinities and what is no number count as black: they would spoil the pixel for good.
void film_add(int layer, ivec2 pixel, vec4 value) {
  bvec4 unusable = film_unusable(value);
  bool spoiled = any(unusable.rgb);
  value = vec4(spoiled ? vec3(0.0) : value.rgb, unusable.a ? 0.0 : value.a);
  film_sum(layer, pixel, value);
  if (layer != FILM_COMBINED) return;
  if (spoiled) atomicAdd(film_spoiled, 1u);
#ifdef FILM_MOMENTS
  // Squares of more would overflow.
  float brightness = clamp(dot(value.rgb, vec3(0.2126, 0.7152, 0.0722)), -1.0e15, 1.0e15);
  film_sum(FILM_MOMENTS, pixel, vec4(brightness, brightness * brightness, 0.0, 0.0));
#endif
}
