// Walks a ray over the pixels of the views and through their fragments (thesis, section 6.2.3).
//
// BY_PLANE 0 is the thesis' test: a fragment is hit by a ray that passes its depth within its pixel. It takes what a
// pixel's centre shows for all of the pixel, so that rays which leave a tilted surface meet it again, and others slip
// through between two pixels. BY_PLANE 1 asks the fragment's triangle: the ray has to meet its plane, near the triangle
// and within half a pixel of this one.
#define STEPS 1
#define HIERARCHY 2
const int START_LEVEL = 3;
#include "fragment_tracer/ray_views.glsl"
#include "fragment_tracer/levels.glsl"
#include "fragment_tracer/fragments.glsl"

const uint TRAVERSAL_WORDS = 13u;

#if TRAVERSAL == HIERARCHY
layout(binding = 4) uniform usamplerBuffer levels;
#endif

// Without the plane: so near to its beginning a ray hits nothing, in widths of a pixel.
const float BLIND = 1.5;
// How far beside a triangle its plane counts, and how far beside a pixel, in widths of a pixel and in parts of the way
// through it.
const float BESIDE = 1.0, BEYOND = 0.5;

bool is_there(Ray ray, uint flags) {
  bool seen = (flags & ray.seen_by) != 0u;
#if SURFACES == 1
  seen = seen && (flags & TRIANGLE_HAS_ALPHA) == 0u;
#elif SURFACES == 2
  seen = seen && (flags & TRIANGLE_HAS_ALPHA) != 0u;
#endif
  return seen;
}

void keep_closer(Ray ray, float t, Data found, inout TracedHit hit) {
  bool ahead = t > ray.t_min || (t == ray.t_min && found.primitive > ray.after);
  bool closer = t < hit.t || (t == hit.t && found.primitive < hit.primitive);
  if (ahead && closer) hit = TracedHit(t, found.primitive, found.barycentrics.x, found.barycentrics.y);
}

// A fragment at `depth` that is near enough to the ray's depths.
void meet(Ray ray, Traversal at, float depth, inout TracedHit hit) {
  Data found = fetch_data(at.entry);
  float width = block.views[at.view].x.w * depth;
#if BY_PLANE
  Corners corners = fetch_corners(found.primitive);
  vec3 edge1 = corners.p1 - corners.p0, edge2 = corners.p2 - corners.p0, from_origin = corners.p0 - ray.origin;
  // With the same bits in every program, or a ray that goes on behind a surface would meet it again.
  precise vec3 normal = edge1.yzx * edge2.zxy - edge1.zxy * edge2.yzx;
  precise float facing = ray.direction.x * normal.x + ray.direction.y * normal.y + ray.direction.z * normal.z;
  precise float distance = from_origin.x * normal.x + from_origin.y * normal.y + from_origin.z * normal.z;
  float t = distance / facing;
  vec3 offset = ray.direction * t - from_origin;
  float inverse = 1.0 / dot(normal, normal);
  float b1 = clamp(dot(cross(offset, edge2), normal) * inverse, 0.0, 1.0);
  float b2 = clamp(dot(cross(edge1, offset), normal) * inverse, 0.0, 1.0 - b1);
  float beside = length(offset - b1 * edge1 - b2 * edge2);
  float margin = BEYOND * (at.cell_end - at.cell_start), s = t - at.t_start;
  bool near = s >= at.cell_start - margin && s <= at.cell_end + margin && beside <= BESIDE * width;
  found.barycentrics = vec2(b1, b2);
  if (near && facing != 0.0 && is_there(ray, corners.flags)) keep_closer(ray, t, found, hit);
#else
  uint flags = floatBitsToUint(texelFetch(triangles, int(found.primitive) * 3 + 2).w);
  float s = at.slope.z != 0.0 ? (depth - at.start.z) / at.slope.z : at.cell_start;
  float t = at.t_start + clamp(s, at.cell_start, at.cell_end);
  bool blind = (t - ray.t_min) * length(ray.direction) < BLIND * width;
  if (!blind && is_there(ray, flags)) keep_closer(ray, t, found, hit);
#endif
}

// One fragment of the list.
void step_list(Ray ray, inout Traversal at, inout TracedHit hit) {
  COUNT_TEST
  float depth = node_depth(at.entry);
  vec2 wanted = hit_depths(at, ray_depths(at));
  bool over = walks_forward(at) ? depth > wanted.y : depth < wanted.x;
  for (int turn = depth >= wanted.x && depth <= wanted.y ? 0 : 1; turn < 1; ++turn) {
    float before = hit.t;
    meet(ray, at, depth, hit);
    if (hit.t < before) {
      at.s_end = min(at.s_end, hit.t - at.t_start);
      at.view_end = min(at.view_end, at.s_end);
    }
  }
  next_fragment(at, over);
#if !BY_PLANE
  // The first that is met from the ray's side is the one (Figure 6.5).
  if (hit.primitive != NO_PRIMITIVE && (LINKS != 1 || at.slope.z >= 0.0)) at.listing = false;
#endif
  at.alive = at.alive && at.s <= at.view_end;
}

#if TRAVERSAL == STEPS
// The place of the ray after a part of its way over the view's pixels.
float s_of(Traversal at, float from, float to, float part) {
  float z0 = at.start.z + from * at.slope.z, z1 = at.start.z + to * at.slope.z;
  return from + (to - from) * part * z0 / max((1.0 - part) * z1 + part * z0, 1.0e-30);
}

// One of a fixed number of pixels, which stands for its share of the way.
void step_cell(inout Traversal at) {
  COUNT_STEP
  float parts = float(block.walk.x);
  at.cell_start = s_of(at, at.view_from, at.view_last, float(at.level) / parts);
  at.cell_end = s_of(at, at.view_from, at.view_last, float(at.level + 1) / parts);
  at.cell = cell_at(at, s_of(at, at.view_from, at.view_last, (float(at.level) + at.jitter) / parts), 0);
  ++at.level;
  begin_list(at, pixel_number(at.view, at.cell));
  at.alive = at.level < block.walk.x && at.cell_end < at.view_end;
  at.s = at.alive ? at.cell_end : at.view_last;
}
#else
// One pixel, or with the hierarchy one cell of the pyramid.
void step_cell(inout Traversal at) {
  COUNT_STEP
  float size = float(1 << at.level);
  vec2 border = (vec2(at.cell) + at.far_side) * size;
  vec2 away = at.slope.xy - border * at.slope.z, crossing = (border * at.start.z - at.start.xy) / away;
  // Not out of the view: where that ends, the ray's interval in it does, and the next view's begins.
  ivec2 next = at.cell + ivec2(at.turn), most = (block.views[at.view].size.xy - 1) >> at.level;
  bvec2 leaves = bvec2(next.x < 0 || next.x > most.x, next.y < 0 || next.y > most.y);
  float s_x = away.x * at.turn.x > 0.0 && !leaves.x ? crossing.x : NEVER;
  float s_y = away.y * at.turn.y > 0.0 && !leaves.y ? crossing.y : NEVER;
  bool through_x = s_x <= s_y;
  float s_next = min(max(through_x ? s_x : s_y, at.s), at.view_end);
  at.cell_start = at.s;
  at.cell_end = s_next;
#if TRAVERSAL == HIERARCHY
  vec2 wanted = hit_depths(at, ray_depths(at));
  uvec2 bits = texelFetch(levels, level_index(at.view, at.level, at.cell)).xy;
  vec2 bounds = uintBitsToFloat(bits);
  bool full = bits.x <= bits.y && wanted.y >= bounds.x && wanted.x <= bounds.y;
  if (full && at.level > 0) {
    --at.level;
    at.cell = clamp(cell_here(at, at.level), 2 * at.cell, 2 * at.cell + 1);
    return;
  }
  if (full) begin_list(at, pixel_number(at.view, at.cell));
#else
  begin_list(at, pixel_number(at.view, at.cell));
#endif
  ivec2 neighbour = at.cell + (through_x ? ivec2(at.turn.x, 0) : ivec2(0, at.turn.y));
  at.alive = s_next < at.view_end;
  at.s = at.alive ? s_next : at.view_last;
#if TRAVERSAL == HIERARCHY
  // Up where that has another parent.
  bool up = any(notEqual(neighbour >> 1, at.cell >> 1)) && at.level < block.views[at.view].size.w;
  at.cell = up ? neighbour >> 1 : neighbour;
  at.level += up ? 1 : 0;
#else
  at.cell = neighbour;
#endif
}
#endif

#include "tracing/walk_views.glsl"

void traversal_save(Traversal at, uint word) {
  put_word(word, uint(at.view) | (at.alive ? 8u : 0u) | (at.listing ? 16u : 0u) | uint(at.bucket) << 8u |
                     uint(at.last_bucket) << 16u);
  put_word(word + 1u, uint(at.cell.x) & 0xffffu | uint(at.cell.y) << 16u);
  put_word(word + 2u, floatBitsToUint(at.s));
  put_word(word + 3u, floatBitsToUint(at.s_end));
  put_word(word + 4u, floatBitsToUint(at.view_end));
  put_word(word + 5u, floatBitsToUint(at.view_last));
  put_word(word + 6u, floatBitsToUint(at.view_from));
  put_word(word + 7u, floatBitsToUint(at.cell_start));
  put_word(word + 8u, floatBitsToUint(at.cell_end));
  put_word(word + 9u, at.entry);
  put_word(word + 10u, uint(at.left));
  put_word(word + 11u, at.pixel);
  put_word(word + 12u, uint(at.level));
}

#if RESUMED
Traversal traversal_load(Ray ray, uint word) {
  Traversal at = traversal_begin(ray);
  uint bits = get_word(word), cell = get_word(word + 1u);
  at.view = int(bits & 7u);
  at.alive = (bits & 8u) != 0u;
  at.listing = (bits & 16u) != 0u;
  at.bucket = int(bits >> 8u & 255u);
  at.last_bucket = int(bits >> 16u & 255u);
  at.cell = ivec2(cell & 0xffffu, cell >> 16u);
  at.s = uintBitsToFloat(get_word(word + 2u));
  at.s_end = uintBitsToFloat(get_word(word + 3u));
  at.view_end = uintBitsToFloat(get_word(word + 4u));
  at.view_last = uintBitsToFloat(get_word(word + 5u));
  at.view_from = uintBitsToFloat(get_word(word + 6u));
  at.cell_start = uintBitsToFloat(get_word(word + 7u));
  at.cell_end = uintBitsToFloat(get_word(word + 8u));
  at.entry = get_word(word + 9u);
  at.left = int(get_word(word + 10u));
  at.pixel = get_word(word + 11u);
  at.level = int(get_word(word + 12u));
  set_view(at);
  return at;
}
#endif
