// What a path knows between two surfaces, what is stored of a surface, and what a frame's paths share.
// All positions are about the origin of the list of triangles, metres.
#pragma once

#include "base/cpp_glsl.h"

SHARED_BEGIN

// One path, as two texels; with LIGHT_PASSES two more: the shares of its light that belong to the
// first surface's diffuse and glossy lobes (the rest is transmission).
struct PathState {
  float throughput_r, throughput_g, throughput_b;
  float scattering_pdf;  // of its direction, 1/sr; 0: it could go nowhere else, or left the camera
  float least_pdf;       // of all its directions
  uint normal;           // pack_unit() of the smooth normal that it left
  uint turns;            // as path_state.glsl packs it
  float way;              // from the camera on, metres
};
SHARED_ASSERT_SIZE(PathState, 32)

// Light on its way along a shadow ray: what arrives if nothing stops it.
struct Arrival {
  float r, g, b;
  uint source;      // LIGHT_KNOWN, or what the light still has to be multiplied by
  uint scatterings; // of the light, up to the camera
  uint padding0, padding1, padding2;
};
SHARED_ASSERT_SIZE(Arrival, 32)

struct PathFrame {
  vec4 camera;   // xyz: its place; w: rays from surfaces end here, metres
  vec4 lens_x;   // xyz: the aperture's half width, world axes; w: distance of the focus along the axis
  vec4 lens_y;   // xyz: its half height; w: corners of it
  vec4 clip;     // x, y: depths of near and far plane; z: width of the pixel filter, pixels;
                 // w: width of a pixel at distance 1 (perspective) or everywhere
  vec4 clamps;   // x, y: most direct and indirect light; z: 1 / filter glossy; w: reach of AO, metres
  uvec4 limits;  // scatterings: total, diffuse, glossy, transmission
  uvec4 range;   // x: index of the sample; y: seed; z: first of the listed pixels; w: paths
  uvec4 size;    // x: width of the picture; y: most transparent layers
};
SHARED_ASSERT_SIZE(PathFrame, 128)

SHARED_END

#ifndef __cplusplus
layout(std140, binding = 1) uniform PathBlock { PathFrame frame; };
#endif
