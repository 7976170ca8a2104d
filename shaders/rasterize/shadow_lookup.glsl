// How much of a lamp's light arrives at a point: lookups into shadow maps.
//
// Each texel is compared with the depth at which its own ray meets the receiver's plane. So a tilted
// plane neither shades itself nor shifts the edges that others cast on it; what remains, the
// surface's curvature and the texel's own tilt, is covered by moving the receiver towards the light
// by a part of a texel.
//
// With FILTERED_PENUMBRAE a lamp that has an extent is seen from its centre only, and its shadow's
// edges are widened by the distance between receiver and blockers (Fernando 2005). Without it every
// sample of the film sees the lamp from another of its points.
#include "gpu_scene/lights_shared.h"
#include "rasterize/cube_face.glsl"
#include "rasterize/receiver.glsl"

layout(std430, binding = 4) readonly buffer ShadowFaces { ShadowFace shadow_faces[]; };
layout(binding = 13) uniform sampler2DArray shadow_maps;  // reversed depth

// The receiver as one face of a lamp's map sees it.
struct ShadowView {
  ShadowFace face;
  bool perspective;
  vec2 place;     // in texels, of the face's own grid
  float depth;    // along the axis
  // The receiver's plane, moved towards the light, as the map would store it: there, and a texel further. What a map
  // stores of a plane is linear over its texels.
  float stored;
  vec2 rise;
  vec2 range;     // as far as the plane is followed: the least and the most
  float horizon;  // below it the plane is met nowhere
};

// How far a surface may rise from texel to texel, in texels, before its slope counts no further.
const float STEEPEST = 256.0;

float stored_depth(ShadowView v, float depth) {
  return v.perspective ? v.face.depth.x / depth + v.face.depth.y : v.face.depth.x * depth + v.face.depth.y;
}

// False where the face does not see the receiver.
bool look_at(ShadowFace f, Receiver r, vec3 to_light, out ShadowView v) {
  v.face = f;
  v.perspective = f.axis.w > 0.5;
  vec3 n = r.geometric_normal;
  float cosine = dot(n, to_light);
  // Near the terminator the look-up moves to the smooth surface that the normals describe; the
  // range over which it does is Cycles'.
  float smooth_cosine = dot(r.smooth_normal, to_light);
  float amount = smooth_cosine < 0.1 ? 2.0 - (cosine + smooth_cosine) / 0.1 : 1.0 - cosine / 0.1;
  vec3 p = r.position + r.smooth_normal * (r.bulge * clamp(amount, 0.0, 1.0)) - f.origin.xyz;
  // Facets that see the light edge-on stand in each other's way: lift them off by a texel.
  float distance_along = v.perspective ? dot(p, f.axis.xyz) : 1.0;
  p += r.smooth_normal * (f.origin.w * distance_along * clamp(1.0 - 50.0 * cosine, 0.0, 1.0));
  v.depth = dot(p, f.axis.xyz);
  float spread = v.perspective ? v.depth : 1.0;
  vec2 ndc = vec2(dot(p, f.x.xyz), dot(p, f.y.xyz)) / spread - vec2(f.x.w, f.y.w);
  if (f.half_extent.z < 0.0 || spread <= 0.0 || any(greaterThan(abs(ndc), vec2(1.0)))) return false;
  v.place = (ndc * 0.5 + 0.5) * f.half_extent.w - 0.5;

  // The plane in the map's frame, per unit of the map's coordinates; depths are taken relative to
  // the receiver's, since the normal is not exact enough for the plane's distance from the lamp.
  float along = v.perspective ? dot(n, p) / v.depth : dot(n, f.axis.xyz);
  vec2 slope = vec2(dot(n, f.x.xyz) * f.half_extent.x * f.half_extent.x,
                    dot(n, f.y.xyz) * f.half_extent.y * f.half_extent.y) * (2.0 / f.half_extent.w);
  slope /= abs(along) > 1.0e-20 ? along : 1.0e-20;
  float texel = f.origin.w * spread;
  float tangent = sqrt(max(1.0 - cosine * cosine, 0.0)) / max(abs(cosine), 1.0e-6);
  float magnitude = max(max(abs(p.x), abs(p.y)), abs(p.z));
  float moved = v.depth - texel * (0.5 + 0.25 * min(tangent, 2.0)) - 1.0e-6 * magnitude;
  float reach = STEEPEST * texel;
  // The plane may go on behind the far end, where the map says that nothing is.
  v.range = max(vec2(stored_depth(v, moved + reach), stored_depth(v, max(moved - reach, f.depth.z))), 0.0);
  v.stored = stored_depth(v, max(moved, f.depth.z));
  v.rise = slope * (v.perspective ? v.stored - f.depth.y : -f.depth.x);
  v.horizon = v.perspective ? f.depth.y : -3.0e38;
  return true;
}

// What the map would store `offset` texels from the receiver if its plane were there.
float plane_depth(ShadowView v, vec2 offset) {
  float stored = v.stored + dot(offset, v.rise);
  return stored < v.horizon ? v.range.y : clamp(stored, v.range.x, v.range.y);
}

const vec2 TAPS[4] = vec2[4](vec2(0.0, 1.0), vec2(1.0, 1.0), vec2(1.0, 0.0), vec2(0.0, 0.0));

// The four texels around a place of the face's grid, in the order of TAPS.
vec4 gather(ShadowView v, vec2 corner) {
  vec2 inside = clamp(corner + 1.0, vec2(1.0), vec2(v.face.half_extent.w - 1.0));
  return textureGather(shadow_maps, vec3(inside / float(textureSize(shadow_maps, 0).x),
                                         v.face.half_extent.z));
}

// The mean of the four nearest texels.
float nearest_texels(ShadowView v) {
  vec2 corner = floor(v.place), fraction = v.place - corner;
  vec4 stored = gather(v, corner);
  float lit = 0.0;
  for (int i = 0; i < 4; ++i) {
    vec2 weight = mix(1.0 - fraction, fraction, TAPS[i]);
    lit += weight.x * weight.y * (plane_depth(v, TAPS[i] - fraction) >= stored[i] ? 1.0 : 0.0);
  }
  return lit;
}

#if FILTERED_PENUMBRAE
// Taps of the search for blockers and of the filter, four texels each: enough that their pattern,
// turned from pixel to pixel, shows as a fine grain.
const int DISK_TAPS = 16;
// Blockers nearer to the lamp than this share of the receiver's distance are not searched for: their
// penumbrae are so wide that they shade hardly at all.
const float NEAREST_BLOCKER = 0.2;
// Of the map's width, on either side; a wider search would step over what it looks for.
const float WIDEST_SEARCH = 0.08;

// Points of a disk, evenly spread (Vogel 1979): each is turned on from the one before by the golden angle.
const mat2 GOLDEN_TURN = mat2(-0.73736888, 0.67549029, -0.67549029, -0.73736888);

float disk_radius(int i) { return sqrt((float(i) + 0.5) / float(DISK_TAPS)); }

// Radius of the penumbra at the receiver's place in the map, in texels, for a blocker at `depth`.
float penumbra(ShadowView v, float size, float depth) {
  float extent = v.perspective ? size * (1.0 / depth - 1.0 / v.depth) : size * (v.depth - depth);
  return extent / v.face.half_extent.x * 0.5 * v.face.half_extent.w;
}

// `size`: the lamp's radius in metres; of suns the tangent of their half angle.
float filtered(ShadowView v, float size, float random) {
  if (size <= 0.0) return nearest_texels(v);
  float nearest = v.perspective ? max(v.depth * NEAREST_BLOCKER, v.face.depth.z) : v.face.depth.z;
  float widest = WIDEST_SEARCH * v.face.half_extent.w;
  float search = min(penumbra(v, size, nearest), widest);
  float blockers = 0.0, depths = 0.0;
  vec2 first = vec2(cos(random * 6.28318531), sin(random * 6.28318531)), direction = first;
  for (int i = 0; i < DISK_TAPS; ++i, direction = GOLDEN_TURN * direction) {
    vec2 at = v.place + direction * (disk_radius(i) * search), corner = floor(at);
    vec4 stored = gather(v, corner);
    for (int k = 0; k < 4; ++k)
      if (stored[k] > plane_depth(v, corner + TAPS[k] - v.place)) {
        float difference = stored[k] - v.face.depth.y;
        blockers += 1.0;
        depths += v.perspective ? v.face.depth.x / difference : difference / v.face.depth.x;
      }
  }
  if (blockers == 0.0) return nearest_texels(v);
  float radius = min(penumbra(v, size, min(depths / blockers, v.depth)), widest);
  if (radius < 1.0) return nearest_texels(v);
  float lit = 0.0;
  direction = first;
  for (int i = 0; i < DISK_TAPS; ++i, direction = GOLDEN_TURN * direction) {
    vec2 at = v.place + direction * (disk_radius(i) * radius), corner = floor(at);
    vec2 fraction = at - corner;
    vec4 stored = gather(v, corner);
    for (int k = 0; k < 4; ++k) {
      vec2 weight = mix(1.0 - fraction, fraction, TAPS[k]);
      bool open = plane_depth(v, corner + TAPS[k] - v.place) >= stored[k];
      lit += weight.x * weight.y * (open ? 1.0 : 0.0);
    }
  }
  return lit / float(DISK_TAPS);
}
#endif

// The share of `light` that arrives at the receiver, 0..1.
float shadow(Light light, Receiver receiver, vec3 to_light) {
  uint first = light.shadow, last = first + light.faces;
  if (light.faces == CUBE_FACES) {
    first += cube_face(receiver.position - light.position.xyz);
    last = first + 1u;
  }
  // A sun's faces are cascades, finest first.
  ShadowView v;
  bool seen = false;
  for (uint face = first; face < last && !seen; ++face)
    seen = look_at(shadow_faces[face], receiver, to_light, v);
  if (!seen) return 1.0;
#if FILTERED_PENUMBRAE
  return filtered(v, light.cone.z, receiver.random);
#else
  return nearest_texels(v);
#endif
}
