// One sample of each path's pixel, into the film.
#include "base/invocation.glsl"
#include "path_tracer/path_shared.h"
#include "film/film.glsl"

layout(local_size_x = 64) in;
layout(binding = 4) uniform samplerBuffer sums;
#if LISTED
layout(std430, binding = 4) readonly buffer Pixels { uint pixels[]; };
#endif

void main() {
  uint path = invocation();
  if (path >= frame.range.w) return;
#if LISTED
  uint number = pixels[frame.range.z + path];
#else
  uint number = frame.range.z + path;
#endif
  ivec2 pixel = ivec2(number % frame.size.x, number / frame.size.x);
  int first = int(path) * PASSES;
  film_add(FILM_COMBINED, pixel, texelFetch(sums, first));
#ifdef PASS_NORMAL
  film_add(FILM_NORMAL, pixel, texelFetch(sums, first + PASS_NORMAL));
#endif
#ifdef PASS_DIFFCOL
  film_add(FILM_DIFFCOL, pixel, texelFetch(sums, first + PASS_DIFFCOL));
#endif
#ifdef PASS_DIFFDIR
  film_add(FILM_DIFFDIR, pixel, texelFetch(sums, first + PASS_DIFFDIR));
#endif
#ifdef PASS_DIFFIND
  film_add(FILM_DIFFIND, pixel, texelFetch(sums, first + PASS_DIFFIND));
#endif
#ifdef PASS_GLOSSCOL
  film_add(FILM_GLOSSCOL, pixel, texelFetch(sums, first + PASS_GLOSSCOL));
#endif
#ifdef PASS_GLOSSDIR
  film_add(FILM_GLOSSDIR, pixel, texelFetch(sums, first + PASS_GLOSSDIR));
#endif
#ifdef PASS_GLOSSIND
  film_add(FILM_GLOSSIND, pixel, texelFetch(sums, first + PASS_GLOSSIND));
#endif
#ifdef PASS_TRANSCOL
  film_add(FILM_TRANSCOL, pixel, texelFetch(sums, first + PASS_TRANSCOL));
#endif
#ifdef PASS_TRANSDIR
  film_add(FILM_TRANSDIR, pixel, texelFetch(sums, first + PASS_TRANSDIR));
#endif
#ifdef PASS_TRANSIND
  film_add(FILM_TRANSIND, pixel, texelFetch(sums, first + PASS_TRANSIND));
#endif
#ifdef PASS_EMIT
  film_add(FILM_EMIT, pixel, texelFetch(sums, first + PASS_EMIT));
#endif
#ifdef PASS_ENV
  film_add(FILM_ENV, pixel, texelFetch(sums, first + PASS_ENV));
#endif
#ifdef PASS_AO
  film_add(FILM_AO, pixel, texelFetch(sums, first + PASS_AO));
#endif
}
