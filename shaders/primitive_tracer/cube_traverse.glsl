// Walks a ray through the perspective views (thesis, section 7.3.2.1): view by view, in each over the
// tiles and up and down the pyramid of depth bounds, and through the lists of the tiles at whose
// depths it passes. The interface is that of native/tracing/tracer.h.
//
// Each view is an interval of the ray, in a frustum a little wider than the view, so that a ray along
// an edge of the cube falls between no two. In a view, tile coordinates only ever grow or only ever
// fall along a ray, so that cells are counted in whole numbers and errors do not add up. A hit counts
// wherever it lies, and ends the search where the next cell begins behind it: Algorithm 2 rejects
// hits that rounding puts beside their tile (line 14) and takes one that lies in a later bucket for
// the closest (line 18). THESIS_REJECTION shows what that loses.
#include "primitive_tracer/cube.glsl"

layout(binding = 1) uniform usamplerBuffer nodes;    // least and greatest depth; lists
layout(binding = 2) uniform usamplerBuffer offsets;  // of buckets in ids; first links of buckets
layout(binding = 3) uniform usamplerBuffer ids;      // primitives; links: primitive, next

const uint TRAVERSAL_WORDS = 8u;

const int START_LEVEL = 3;  // 8x8 tiles: higher levels are seldom empty
const int STRIDE = 2;       // levels of the pyramid at a time
const float WIDENED = 1.00001;

struct Traversal {
  // The ray from where it enters the scene's box: t = t_start + s.
  float t_start;
  vec3 origin, direction;   // origin relative to the centre
  float s_end;              // the end of the ray or its closest hit
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
float end_of(float t, float t_start) { return t - t_start + 1e-6 * max(abs(t), abs(t_start)); }

void clip(float offset, float slope, inout vec2 span) {
  float s = -offset / slope;
  if (slope > 0.0) span.x = max(span.x, s);
  else if (slope < 0.0) span.y = min(span.y, s);
  else if (offset < 0.0) span.y = -1.0;
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
  // The part of the ray in the scene's box.
  vec3 to_low = (cube.low.xyz - ray.origin) / ray.direction;
  vec3 to_high = (cube.high.xyz - ray.origin) / ray.direction;
  bvec3 still = equal(ray.direction, vec3(0.0));
  vec3 enter = mix(min(to_low, to_high), vec3(ray.t_min), still);
  vec3 leave = mix(max(to_low, to_high), vec3(ray.t_max), still);
  bvec3 beside = notEqual(equal(clamp(ray.origin, cube.low.xyz, cube.high.xyz), ray.origin), bvec3(true));
  float t0 = max(ray.t_min, max(enter.x, max(enter.y, enter.z)));
  float t1 = min(ray.t_max, min(leave.x, min(leave.y, leave.z)));
  t0 = max(ray.t_min, t0 - 1e-6 * abs(t0));
  t1 += 1e-6 * abs(t1);
  bool meets = t0 <= t1 && !(still.x && beside.x) && !(still.y && beside.y) && !(still.z && beside.z);

  at.t_start = t0;
  // In double precision, so that a ray from far away loses nothing on its way to the box.
  at.origin = vec3(dvec3(ray.origin) + double(t0) * dvec3(ray.direction) - dvec3(cube.centre.xyz));
  at.direction = ray.direction;
  at.s_end = end_of(t1, t0);
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

int bucket_count(uvec4 node) {
#if LINKED_LISTS
  return cube.grid.z;
#else
  return int(node.w);
#endif
}

// What of the tile's buckets lies between two depths.
void begin_list(inout Traversal at, int tile, uvec4 node, uint low, uint high) {
  at.tile = tile;
  int from = bucket_of(low, node.xy, bucket_count(node)), to = bucket_of(high, node.xy, bucket_count(node));
#if LINKED_LISTS
  bool forward = at.slope.z >= 0.0;
  at.bucket = forward ? from : to;
  at.last_bucket = forward ? to : from;
  at.entry = texelFetch(offsets, tile * cube.grid.z + at.bucket).x;
  at.entry_end = 0u;  // counts what is tested
  at.listing = true;
#else
  at.entry = texelFetch(offsets, int(node.z) + from).x;
  at.entry_end = texelFetch(offsets, int(node.z) + to + 1).x;
  at.listing = at.entry < at.entry_end;
  COUNT_LIST(uint(tile), at.entry_end - at.entry)
#endif
}

// One cell of the view.
void step_cell(inout Traversal at) {
  COUNT_STEP
  // Where the ray leaves the cell. By comparisons here and below: minima and maxima that mind NaN take
  // three instructions each.
  float size = power_of_two(at.level);
  vec2 border = (vec2(at.cell) + at.far_side) * size;
  vec2 away = at.slope.xy - border * at.slope.z;
  vec2 crossing = (border * at.start.z - at.start.xy) / away;
  float s_x = away.x * at.turn.x > 0.0 ? crossing.x : NEVER;
  float s_y = away.y * at.turn.y > 0.0 ? crossing.y : NEVER;
  bool through_x = s_x <= s_y;
  float s_out = through_x ? s_x : s_y;
  float s_next = s_out > at.s ? s_out : at.s;
  float depth_next = at.start.z + (s_next < at.view_end ? s_next : at.view_end) * at.slope.z;
  bool rising = depth_next > at.depth;
  uint low = depth_code((rising ? at.depth : depth_next) - DEPTH_MARGIN);
  uint high = depth_code((rising ? depth_next : at.depth) + DEPTH_MARGIN);

  int index = node_index(at.view, at.level, at.cell);
  uvec4 node = texelFetch(nodes, index);
  bool hit = high >= node.x && low <= node.y;
  if (hit && at.level == 0) begin_list(at, index, node, low, high);

  // Down to the child that holds the ray at s.
  bool down = hit && at.level > 0;
  int levels_down = min(STRIDE, at.level);
  ivec2 corner = at.cell << levels_down;
  vec3 place = at.start + at.s * at.slope;
  vec2 child = floor(place.xy * (power_of_two(levels_down - at.level) / place.z));
  child = clamp(child, vec2(corner), vec2(corner + (1 << levels_down) - 1));
  // On to the neighbour, and up where that has another parent.
  ivec2 neighbour = at.cell + (through_x ? ivec2(at.turn.x, 0) : ivec2(0, at.turn.y));
  int levels_up = min(STRIDE, cube.grid.y - at.level);
  ivec2 changed = (neighbour ^ at.cell) >> levels_up;
  if ((changed.x | changed.y) == 0) levels_up = 0;
  uint side = uint(cube.grid.x >> at.level);
  at.alive = down || (s_next < at.view_end && uint(neighbour.x) < side && uint(neighbour.y) < side);
  at.cell = down ? ivec2(child) : neighbour >> levels_up;
  at.level = down ? at.level - levels_down : at.level + levels_up;
  at.s = down ? at.s : s_next;
  at.depth = down ? at.depth : depth_next;
}

// The hit at hit.t ends the list where it lies, and the walk.
void shorten(inout Traversal at, TracedHit hit) {
  at.s_end = min(at.s_end, end_of(hit.t, at.t_start));
  at.view_end = min(at.view_end, at.s_end);
  bool forward = at.slope.z >= 0.0;
  uint depth = depth_code(at.start.z + at.s_end * at.slope.z + (forward ? DEPTH_MARGIN : -DEPTH_MARGIN));
  uvec4 node = texelFetch(nodes, at.tile);
  int bucket = bucket_of(depth, node.xy, bucket_count(node));
#if LINKED_LISTS
  at.last_bucket = forward ? min(at.last_bucket, bucket) : max(at.last_bucket, bucket);
#else
  uint border = texelFetch(offsets, int(node.z) + bucket + (forward ? 1 : 0)).x;
  if (forward) at.entry_end = min(at.entry_end, border);
  else at.entry = max(at.entry, border);
#endif
}

// One triangle of the list, from the ray's side.
void step_list(Ray ray, inout Traversal at, inout TracedHit hit) {
  bool forward = at.slope.z >= 0.0;
#if LINKED_LISTS
  if (at.entry != NO_LINK) {
    uvec2 link = texelFetch(ids, int(at.entry)).xy;
    at.entry = link.y;
    TracedHit before = hit;
    intersect(ray, link.x, hit);
    ++at.entry_end;
    COUNT_LIST(uint(at.tile), at.entry_end)
#if THESIS_REJECTION
    vec3 place = at.start + (hit.t - at.t_start) * at.slope;
    if (node_index(at.view, 0, ivec2(floor(place.xy / place.z))) != at.tile) hit = before;
#else
    for (int turn = hit.t < before.t ? 0 : 1; turn < 1; ++turn) shorten(at, hit);
#endif
  }
  if (at.entry == NO_LINK) {
    at.listing = forward ? at.bucket < at.last_bucket : at.bucket > at.last_bucket;
    at.bucket += forward ? 1 : -1;
    if (at.listing) at.entry = texelFetch(offsets, at.tile * cube.grid.z + at.bucket).x;
#if THESIS_REJECTION
    if (hit.primitive != NO_PRIMITIVE) {
      at.listing = at.alive = false;
      at.s_end = -1.0;
    }
#endif
  }
#else
  float before = hit.t;
  intersect(ray, texelFetch(ids, int(forward ? at.entry : at.entry_end - 1u)).x, hit);
  if (forward) ++at.entry;
  else --at.entry_end;
  for (int turn = hit.t < before ? 0 : 1; turn < 1; ++turn) shorten(at, hit);
  at.listing = at.entry < at.entry_end;
#endif
  at.alive = at.alive && at.s <= at.s_end;
}

bool traverse(Ray ray, inout Traversal at, inout TracedHit hit, int budget) {
  bool left = true;
  while (left && budget > 0) {
    // A loop of no or one turn, since software skips that where no ray at hand needs it.
    for (int turn = at.alive || at.listing ? 1 : 0; turn < 1; ++turn) {
      left = next_view(at);
      --budget;
    }
    while (at.alive && !at.listing && budget > 0) {
      step_cell(at);
      --budget;
    }
    while (at.listing && budget > 0) {
      step_list(ray, at, hit);
      --budget;
#if ANY_HIT
      if (hit.primitive != NO_PRIMITIVE) return true;
#endif
    }
  }
  return !left;
}

void traversal_save(Traversal at, uint word) {
  put_word(word, at.visited | uint(at.view) << 6u | uint(at.level) << 9u | (at.alive ? 1u << 14u : 0u) |
                     (at.listing ? 1u << 15u : 0u) | uint(at.bucket & 255) << 16u |
                     uint(at.last_bucket) << 24u);
  put_word(word + 1u, uint(at.cell.x) & 0xffffu | uint(at.cell.y) << 16u);
  put_word(word + 2u, floatBitsToUint(at.s));
  put_word(word + 3u, floatBitsToUint(at.s_end));
  put_word(word + 4u, uint(at.tile));
  put_word(word + 5u, at.entry);
  put_word(word + 6u, at.entry_end);
  put_word(word + 7u, floatBitsToUint(at.view_end));
}

#if RESUMED
Traversal traversal_load(Ray ray, uint word) {
  Traversal at = traversal_begin(ray);
  uint bits = get_word(word), cell = get_word(word + 1u);
  at.visited = bits & 63u;
  at.view = int(bits >> 6u & 7u);
  at.level = int(bits >> 9u & 31u);
  at.alive = (bits & 1u << 14u) != 0u;
  at.listing = (bits & 1u << 15u) != 0u;
  at.bucket = int(bits >> 16u & 255u);
  at.last_bucket = int(bits >> 24u);
  at.cell = ivec2(cell & 0xffffu, cell >> 16u);
  at.s = uintBitsToFloat(get_word(word + 2u));
  at.s_end = uintBitsToFloat(get_word(word + 3u));
  at.tile = int(get_word(word + 4u));
  at.entry = get_word(word + 5u);
  at.entry_end = get_word(word + 6u);
  at.view_end = uintBitsToFloat(get_word(word + 7u));
  set_view(at);
  at.depth = at.start.z + at.s * at.slope.z;
  return at;
}
#endif
