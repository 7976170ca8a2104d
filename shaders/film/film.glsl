// Sums of all samples, one layer a pass. A pass that is not asked for has no layer: its FILM_* is
// not defined, and the adding is not compiled.
layout(binding = 7, rgba32f) uniform image2DArray film;

void film_add(int layer, ivec2 pixel, vec4 value) {
  ivec3 place = ivec3(pixel, layer);
  imageStore(film, place, imageLoad(film, place) + value);
}

void film_set(int layer, ivec2 pixel, vec4 value) { imageStore(film, ivec3(pixel, layer), value); }
