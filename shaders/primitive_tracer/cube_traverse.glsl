// Walks a ray through the perspective views (thesis, section 7.3.2.1): view by view, in each over
// the tiles and up and down the pyramid of depth bounds, and through the lists of the tiles at
// whose depths it passes. The interface is that of native/tracing/tracer.h.
//
// In a view, tile coordinates only ever grow or only ever fall along a ray, so that cells are
// counted in whole numbers and errors do not add up. A hit counts wherever it lies, and ends the
// search where the next cell begins behind it: Algorithm 2 rejects hits that rounding puts beside
// their tile (line 14) and takes for the closest one that lies in a later bucket (line 18).
// THESIS_REJECTION shows what that loses.
#include "primitive_tracer/cube_rays.glsl"

const uint TRAVERSAL_WORDS = 8u;

const int STRIDE = 2;  // levels of the pyramid at a time

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
  int from = bucket_of(low, node.xy, bucket_count(node));
  int to = bucket_of(high, node.xy, bucket_count(node));
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
  // Where the ray leaves the cell. By comparisons here and below: minima and maxima that mind NaN
  // take three instructions each.
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
  at.s_end = min(at.s_end, end_of(hit.t, at));
  at.view_end = min(at.view_end, at.s_end);
  bool forward = at.slope.z >= 0.0;
  float margin = forward ? DEPTH_MARGIN : -DEPTH_MARGIN;
  uint depth = depth_code(at.start.z + at.s_end * at.slope.z + margin);
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

#include "tracing/walk_views.glsl"

void traversal_save(Traversal at, uint word) {
  put_word(word, at.visited | uint(at.view) << 6u | uint(at.level) << 9u |
                     (at.alive ? 1u << 14u : 0u) | (at.listing ? 1u << 15u : 0u) |
                     uint(at.bucket & 255) << 16u | uint(at.last_bucket) << 24u);
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
