// A ray's way through the perspective views, for cube_traverse.glsl: its part in the scene's box,
// and the interval in each view.
//
// Each view is an interval of the ray, in a frustum a little wider than the view, so that a ray
// along an edge of the cube falls between no two.
#include "primitive_tracer/cube.glsl"
#include "tracing/spans.glsl"

layout(binding = 1) uniform usamplerBuffer nodes;    // least and greatest depth; lists
layout(binding = 2) uniform usamplerBuffer offsets;  // of buckets in ids; first links of buckets
layout(binding = 3) uniform usamplerBuffer ids;      // primitives; links: primitive, next

const int START_LEVEL = 3;  // 8x8 tiles: higher levels are seldom empty
const float WIDENED = 1.00001;

struct Traversal {
  // The ray from where it enters the scene's box: t = t_start + s.
  float t_start;
  vec3 origin, direction;   // origin relative to the centre
  float s_end;              // the end of the ray or its closest hit
  float slack;              // how far rounding may put a hit off
  float view_start[VIEWS];  // s; NEVER where it passes the view by
  uint visited;             // bits of views
  int view;                 // at hand
  // The ray in the view's tiles: homogeneous, start + s * slope.
  vec3 start, slope;
  vec2 turn, far_side;  // per axis: which way tiles are passed; 1 where they are left above
  // Where it is.
  bool alive;        // in the view
  int level;
  ivec2 cell;
  float s, view_end;
  float depth;       // at s
  // The list that is being tested: of which tile, and what is left of it.
  bool listing;
  int tile;
  uint entry, entry_end;
  int bucket, last_bucket;
};

const float NEVER = 1e38;

float power_of_two(int exponent) { return intBitsToFloat((exponent + 127) << 23); }

// How far s may go once something was met at t; rounding must not end the search too early.
float end_of(float t, Traversal at) {
  return t - at.t_start + 2e-6 * max(abs(t), abs(at.t_start)) + at.slack;
}

// The interval of s in a view; its end lies before its start where there is none.
vec2 span_in(vec3 origin, vec3 direction, float s_end, int view) {
  vec3 o = to_view(origin, view) * cube.centre.w, d = to_view(direction, view) * cube.centre.w;
  o.z = o.z * WIDENED + 2.0 * POSITION_ERROR;
  d.z *= WIDENED;
  vec2 span = vec2(0.0, s_end);
  clip(o.z - o.x, d.z - d.x, span);
  clip(o.z + o.x, d.z + d.x, span);
  clip(o.z - o.y, d.z - d.y, span);
  clip(o.z + o.y, d.z + d.y, span);
  return span;
}

Traversal traversal_begin(Ray ray) {
  Traversal at;
  vec2 part;
  bool meets = part_in_box(ray, cube.low.xyz, cube.high.xyz, part);
  vec3 size = abs(ray.direction);
  at.slack = 4.0 * POSITION_ERROR / (cube.centre.w * max(size.x, max(size.y, size.z)));
  float t0 = part.x - 2e-6 * abs(part.x) - at.slack, t1 = part.y + 2e-6 * abs(part.y) + at.slack;
  meets = meets && t0 <= t1;

  at.t_start = t0;
  // In double precision, so that a ray from far away loses nothing on its way to the box.
  at.origin = vec3(dvec3(ray.origin) + double(t0) * dvec3(ray.direction) - dvec3(cube.centre.xyz));
  at.direction = ray.direction;
  at.s_end = t1 - t0;
  for (int view = 0; view < VIEWS; ++view) {
    vec2 span = span_in(at.origin, at.direction, at.s_end, view);
    at.view_start[view] = meets && span.x <= span.y ? span.x : NEVER;
  }
  at.visited = 0u;
  at.view = 0;
  at.alive = at.listing = false;
  at.start = at.slope = vec3(0.0);
  at.turn = at.far_side = vec2(0.0);
  at.level = at.tile = 0;
  at.cell = ivec2(0);
  at.s = at.view_end = at.depth = 0.0;
  at.entry = at.entry_end = 0u;
  at.bucket = at.last_bucket = 0;
  return at;
}

// The ray in the tiles of at.view.
void set_view(inout Traversal at) {
  at.start = to_tiles(at.origin, at.view);
  at.slope = to_tiles(at.direction, at.view);
  // The sign of the change of x / z and y / z.
  at.turn = sign(at.slope.xy * at.start.z - at.start.xy * at.slope.z);
  at.far_side = vec2(greaterThan(at.turn, vec2(0.0)));
}

// Enters the view whose interval begins first among those left; false when none is left before the
// closest hit.
bool next_view(inout Traversal at) {
  float first = NEVER;
  for (int view = 0; view < VIEWS; ++view)
    if ((at.visited & 1u << view) == 0u && at.view_start[view] < first) {
      first = at.view_start[view];
      at.view = view;
    }
  if (first > at.s_end || first == NEVER) return false;
  at.visited |= 1u << at.view;
  set_view(at);
  vec2 span = span_in(at.origin, at.direction, at.s_end, at.view);

  // No further than the depths that the view has anything at.
  uvec4 all = texelFetch(nodes, node_index(at.view, cube.grid.y, ivec2(0)));
  float near = float(all.x) / float(1u << DEPTH_BITS) - DEPTH_MARGIN;
  float far = float(all.y + 1u) / float(1u << DEPTH_BITS) + DEPTH_MARGIN;
  clip(at.start.z - near, at.slope.z, span);
  clip(far - at.start.z, -at.slope.z, span);
  at.s = span.x;
  at.view_end = span.y;
  at.alive = span.x <= span.y && all.x <= all.y;
  at.depth = at.start.z + at.s * at.slope.z;
  at.level = min(START_LEVEL, cube.grid.y);
  vec3 place = at.start + at.s * at.slope;
  at.cell = ivec2(clamp(floor(place.xy / max(place.z, 1e-30) * power_of_two(-at.level)), 0.0,
                        float((cube.grid.x >> at.level) - 1)));
  return true;
}
