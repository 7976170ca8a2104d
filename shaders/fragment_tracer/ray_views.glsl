// A ray's way through the views: which of them sees it where. The interface is that of native/tracing/tracer.h.
//
// The camera's view has the finer pixels and goes first; the faces of the cube see what is left. Where a ray goes over
// from one view to another it goes on at the same place of the ray, so that nothing is passed over or met twice.
#include "fragment_tracer/views.glsl"
#include "tracing/spans.glsl"

struct Traversal {
  // The ray from where it enters the scene's box: t = t_start + s.
  float t_start;
  vec3 origin, direction;  // origin relative to the centre
  float s_end;             // the end of the ray or its closest hit
  vec2 spans[VIEWS];       // of s in each view; the end before the start where it passes by
  // The view at hand, and the ray in its homogeneous pixels: start + s * slope.
  int view;
  vec3 start, slope;
  vec2 turn, far_side;     // per axis: which way pixels are passed; 1 where they are left above
  bool alive;              // in the view
  ivec2 cell;
  int level;               // of the pyramid; with fixed steps the next of them
  float s, view_end;
  float view_from, view_last;  // of the view's part of the ray, whatever it meets there
  // The list that is being tested, of a pixel that sees the ray from cell_start to cell_end.
  bool listing;
  uint pixel;
  float cell_start, cell_end;
  uint entry;              // the next fragment
  int left;                // of an array: fragments behind it
  int bucket, last_bucket;
  float jitter;            // 0..1, of fixed steps
};

const float NEVER = 1e38;
// Views reach so much further than their sides, so that a ray along an edge of the cube falls between no two.
const float WIDENED = 1.00001;

// The interval of s in which a view sees the ray.
vec2 span_in(vec3 origin, vec3 direction, float s_end, int view) {
  vec3 o = to_pixels(origin, view), d = to_pixels(direction, view);
  vec2 size = vec2(block.views[view].size.xy), margin = size * (WIDENED - 1.0);
  vec2 span = vec2(0.0, s_end);
  for (int axis = 0; axis < 2; ++axis) {
    clip(o[axis] + margin[axis] * o.z, d[axis] + margin[axis] * d.z, span);
    clip((size[axis] + margin[axis]) * o.z - o[axis], (size[axis] + margin[axis]) * d.z - d[axis], span);
  }
  return span;
}

Traversal traversal_begin(Ray ray) {
  Traversal at;
  vec2 part;
  bool meets = part_in_box(ray, block.low.xyz, block.high.xyz, part) && part.x <= part.y;
  at.t_start = part.x;
  // In double precision, so that a ray from far away loses nothing on its way to the box.
  at.origin = vec3(dvec3(ray.origin) + double(part.x) * dvec3(ray.direction) - dvec3(block.centre.xyz));
  at.direction = ray.direction;
  at.s_end = meets ? part.y - part.x : -1.0;
  for (int view = 0; view < VIEWS; ++view)
    at.spans[view] = meets ? span_in(at.origin, at.direction, at.s_end, view) : vec2(0.0, -1.0);
  at.view = 0;
  at.alive = at.listing = false;
  at.start = at.slope = vec3(0.0);
  at.turn = at.far_side = vec2(0.0);
  at.cell = ivec2(0);
  at.level = at.left = at.bucket = at.last_bucket = 0;
  at.s = at.view_end = at.view_from = at.view_last = at.cell_start = at.cell_end = 0.0;
  at.pixel = 0u;
  at.entry = NO_FRAGMENT;
  at.jitter = float(ray.seed >> 8u) / 16777216.0;
  return at;
}

void set_view(inout Traversal at) {
  at.start = to_pixels(at.origin, at.view);
  at.slope = to_pixels(at.direction, at.view);
  // The sign of the change of x / z and y / z; none where rounding decides it, as of rays through the eye.
  vec2 rising = at.slope.xy * at.start.z, falling = at.start.xy * at.slope.z;
  vec2 change = rising - falling, rounding = 4.0e-6 * (abs(rising) + abs(falling));
  at.turn = vec2(abs(change.x) > rounding.x ? sign(change.x) : 0.0, abs(change.y) > rounding.y ? sign(change.y) : 0.0);
  at.far_side = vec2(greaterThan(at.turn, vec2(0.0)));
}

// The pixel, or the cell of so many of them, in which the ray is at s.
ivec2 cell_at(Traversal at, float s, int level) {
  vec3 place = at.start + s * at.slope;
  vec2 pixel = place.xy / max(place.z, 1.0e-30);
  ivec2 last = block.views[at.view].size.xy - 1;
  return ivec2(clamp(floor(pixel), vec2(0.0), vec2(last))) >> level;
}

// The same at at.s; of a ray that comes from the eye or through it, a little further on: there it is nowhere.
ivec2 cell_here(Traversal at, int level) {
  float near = at.start.z + at.s * at.slope.z, far = at.start.z + at.view_last * at.slope.z;
  return cell_at(at, near < 1.0e-4 * far ? mix(at.s, at.view_last, 1.0e-3) : at.s, level);
}

// Enters the view that sees the ray from at.s on, or the next one that does; false when none is left before the end of
// the ray.
bool next_view(inout Traversal at) {
  float start = NEVER, end = -1.0;
  int found = 0;
  for (int view = 0; view < VIEWS; ++view) {
    vec2 span = at.spans[view];
    float from = max(span.x, at.s);
    bool sees = span.y > at.s && from < span.y;
    // Whoever does so first, and of those the longest; but the camera's view before all.
    bool first = from < start || (from == start && span.y > end && !(CAMERA_VIEW == 1 && found == 0));
    if (!sees || !first) continue;
    start = from;
    end = span.y;
    found = view;
  }
#if CAMERA_VIEW
  // Up to where the camera's view begins.
  if (found != 0 && at.spans[0].y > at.spans[0].x && at.spans[0].x > start) end = min(end, at.spans[0].x);
#endif
  if (start > at.s_end || start == NEVER) return false;
  at.view = found;
  at.s = at.view_from = start;
  at.view_last = end;
  at.view_end = min(end, at.s_end);
  at.alive = true;
  set_view(at);
#if TRAVERSAL == STEPS
  at.level = 0;
#else
  at.level = TRAVERSAL == HIERARCHY ? min(START_LEVEL, block.views[at.view].size.w) : 0;
  at.cell = cell_here(at, at.level);
#endif
  return true;
}
