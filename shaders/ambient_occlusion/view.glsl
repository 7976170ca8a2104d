// What a view has recorded where it sees a point: the includer binds the view's depths.
#include "ambient_occlusion/occlusion_shared.h"
#include "rasterize/cube_face.glsl"

layout(std140, binding = 1) uniform OcclusionBlock { OcclusionView occlusion; };
#if CAMERA_VIEW
layout(binding = 0) uniform sampler2D depths;  // reversed, as are all
float stored_depth(ivec2 texel, float layer) { return texelFetch(depths, texel, 0).r; }
#else
layout(binding = 0) uniform sampler2DArray depths;
float stored_depth(ivec2 texel, float layer) { return texelFetch(depths, ivec3(texel, int(layer)), 0).r; }
#endif

// A face of the view, about the surface that is looked at.
struct Face {
  vec3 from;          // the surface, relative to the face's origin
  vec3 x, y, axis;    // as ShadowFace has them
  vec3 across, up;    // from the map's centre to its rim (perspective: at depth 1)
  vec2 shift, texels;
  vec4 depth;
  float layer;        // below 0: the face shows nothing
  bool perspective;
  float texel;        // its width, metres (perspective: at depth 1)
};

Face face_of(ShadowFace f, vec3 position) {
  Face face;
  face.from = position - f.origin.xyz;
  face.x = f.x.xyz;
  face.y = f.y.xyz;
  face.axis = f.axis.xyz;
  face.across = f.x.xyz * (f.half_extent.x * f.half_extent.x);
  face.up = f.y.xyz * (f.half_extent.y * f.half_extent.y);
  face.shift = vec2(f.x.w, f.y.w);
  face.texels = vec2(f.half_extent.w, f.depth.w);
  face.depth = f.depth;
  face.layer = f.half_extent.z;
  face.perspective = f.axis.w > 0.5;
  face.texel = 2.0 * max(f.half_extent.x / face.texels.x, f.half_extent.y / face.texels.y);
  return face;
}

// Where the face has a point at `offset` from the surface: xy in -1..1 inside, z along the axis.
vec3 place_of(Face f, vec3 offset) {
  vec3 q = f.from + offset;
  float depth = dot(q, f.axis);
  return vec3(vec2(dot(q, f.x), dot(q, f.y)) / (f.perspective ? depth : 1.0) - f.shift, depth);
}

bool inside(Face f, vec3 place) {
  return all(lessThan(abs(place.xy), vec2(1.0))) && place.z > f.depth.z && f.layer >= 0.0;
}

// The face by which the view sees the surface best. Points around it may need another one of a cube.
Face main_face(vec3 position) {
#if CUBE
  return face_of(occlusion.faces[cube_face(position - occlusion.faces[0].origin.xyz)], position);
#elif CASCADES
  // Finest first: the first that holds the surface and what is looked for around it; the last
  // that holds the surface at all where there is none.
  uint chosen = 0u;
  bool whole = false;
  for (uint k = 0u; k < occlusion.place.y; ++k) {
    Face f = face_of(occlusion.faces[k], position);
    vec3 place = place_of(f, vec3(0.0));
    vec2 reach = occlusion.range.x * vec2(length(f.x), length(f.y));
    bool holds = inside(f, place);
    if (holds && !whole) chosen = k;
    whole = whole || (holds && all(lessThan(abs(place.xy) + reach, vec2(1.0))));
  }
  return face_of(occlusion.faces[chosen], position);
#else
  return face_of(occlusion.faces[0], position);
#endif
}

// Unit, from the surface to where the view looks from.
vec3 towards_view(Face f) { return f.perspective ? -normalize(f.from + 1.0e-30 * f.axis) : -f.axis; }

struct Look {
  bool seen;     // false: the point lies outside the view
  bool hidden;   // something recorded stands before the point
  vec3 surface;  // what is recorded there, relative to the surface that is looked at, metres
  float error;   // of that, at most, off the plane in which it lies, metres
};

// Rasterisers snap vertices to 1/256 of a texel; depth and positions are rounded.
const float TEXEL_ERROR = 1.0 / 64.0, RELATIVE_ERROR = 2.0e-6;

Look look(Face main, vec3 position, vec3 offset) {
#if CUBE
  Face f = face_of(occlusion.faces[cube_face(main.from + offset)], position);
#else
  Face f = main;
#endif
  vec3 place = place_of(f, offset);
  Look l;
  l.seen = inside(f, place);
  vec2 texel = clamp(floor((0.5 * place.xy + 0.5) * f.texels), vec2(0.0), f.texels - 1.0);
  float stored = stored_depth(ivec2(texel), f.layer);
  l.seen = l.seen && stored > 0.0;
  // The surface lies in the middle of its texel, not where the point is.
  vec2 centre = (texel + 0.5) / f.texels * 2.0 - 1.0 + f.shift;
  vec3 ray = centre.x * f.across + centre.y * f.up;
  if (f.perspective) {
    float depth = f.depth.x / max(stored - f.depth.y, 1.0e-30);
    l.surface = (f.axis + ray) * depth - f.from;
    l.hidden = depth < place.z;
    l.error = TEXEL_ERROR * f.texel * depth;
  } else {
    float depth = (stored - f.depth.y) / f.depth.x;
    l.surface = f.axis * depth + ray - f.from;
    l.hidden = depth < place.z;
    l.error = TEXEL_ERROR * f.texel;
  }
  vec3 largest = max(abs(f.from), abs(l.surface));
  l.error += RELATIVE_ERROR * max(max(largest.x, largest.y), largest.z);
  return l;
}
