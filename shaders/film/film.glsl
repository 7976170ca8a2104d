// Sums of all samples, one layer a pass. A pass that is not asked for has no layer: its FILM_* is
// not defined, and the adding is not compiled.
// Reads go through a sampler: on llvmpipe they are several times faster than image loads.
layout(binding = 7, rgba32f) writeonly uniform image2DArray film;
layout(binding = 8) uniform sampler2DArray film_sums;

void film_add(int layer, ivec2 pixel, vec4 value) {
  ivec3 place = ivec3(pixel, layer);
  imageStore(film, place, texelFetch(film_sums, place, 0) + value);
}
