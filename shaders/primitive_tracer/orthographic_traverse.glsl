// Walks a ray over the tiles of the orthographic view: a two-dimensional DDA whose parameter is t
// itself, up and down the pyramid of masks, and through the lists of the nodes that hold something
// at the ray's depths. The interface is that of native/tracing/tracer.h.
#include "primitive_tracer/orthographic.glsl"

layout(binding = 1) uniform usamplerBuffer nodes;    // as orthographic_shared.h describes them
layout(binding = 2) uniform usamplerBuffer offsets;  // of buckets in ids
layout(binding = 3) uniform usamplerBuffer ids;      // primitives

const uint TRAVERSAL_WORDS = 8u;

const int START_LEVEL = 3;  // 8x8 tiles: higher levels are seldom empty
const int STRIDE = 2;       // levels of the pyramid at a time

struct Traversal {
  // The ray in tiles: position = start + s * direction, with t = t_start + s, so that a ray from far
  // away loses nothing on its way to the box.
  float t_start;
  vec3 start, direction, inverse;  // of the components in x and y
  vec2 far_side;                   // 1 where the ray leaves a cell through its upper side
  ivec2 turn;                      // +1 or -1: the next cell
  // Where it is.
  int level;         // of the pyramid; -k in the parts of a tile that is divided k times
  ivec2 cell;
  int divisions, first_part;  // of the tile
  float s, s_end, slack;     // slack: how far rounding may put a hit off
  float depth;       // at s
  bool alive;
  uint entry, entry_end;  // of the list that is being tested
};

float power_of_two(int exponent) { return intBitsToFloat((exponent + 127) << 23); }

// How far s may go once something was met at t; rounding must not end the search too early.
float end_of(float t, Traversal at) {
  return t - at.t_start + 2e-6 * max(abs(t), abs(at.t_start)) + at.slack;
}

Traversal traversal_begin(Ray ray) {
  Traversal at;
  vec3 scale = vec3(box.low.ww, box.depth.x);
  vec3 direction = axis_last(ray.direction, box.grid.x) * scale;
  vec3 origin = to_tiles(ray.origin);

  // The part of the ray in the box, a little widened, as everything that is listed is.
  vec3 margin = vec3(1e-4, 1e-4, 1e-6);
  vec3 to_low = (-margin - origin) / direction;
  vec3 to_high = (vec3(vec2(box.grid.y), 1.0) + margin - origin) / direction;
  bvec3 still = equal(direction, vec3(0.0));
  vec3 enter = mix(min(to_low, to_high), vec3(ray.t_min), still);
  vec3 leave = mix(max(to_low, to_high), vec3(ray.t_max), still);
  bvec3 outside = bvec3(origin.x < -margin.x || origin.x > float(box.grid.y) + margin.x,
                        origin.y < -margin.y || origin.y > float(box.grid.y) + margin.y,
                        origin.z < -margin.z || origin.z > 1.0 + margin.z);
  float t0 = max(ray.t_min, max(enter.x, max(enter.y, enter.z)));
  float t1 = min(ray.t_max, min(leave.x, min(leave.y, leave.z)));
  vec3 size = abs(ray.direction);
  at.slack = box.depth.z / max(size.x, max(size.y, size.z));
  t0 -= 2e-6 * abs(t0) + at.slack;
  t1 += 2e-6 * abs(t1) + at.slack;
  at.alive = t0 <= t1 && !(still.x && outside.x) && !(still.y && outside.y) && !(still.z && outside.z);

  at.t_start = t0;
  dvec3 entry = dvec3(ray.origin) + double(t0) * dvec3(ray.direction) - dvec3(box.low.xyz);
  at.start = axis_last(vec3(entry), box.grid.x) * scale;
  at.direction = direction;
  at.inverse = mix(1.0 / direction, vec3(1e30), still);
  at.far_side = vec2(direction.x >= 0.0 ? 1.0 : 0.0, direction.y >= 0.0 ? 1.0 : 0.0);
  at.turn = ivec2(direction.x >= 0.0 ? 1 : -1, direction.y >= 0.0 ? 1 : -1);

  at.s = 0.0;
  at.s_end = t1 - t0;
  at.depth = at.start.z;
  at.level = min(START_LEVEL, box.grid.z);
  at.cell = clamp(ivec2(floor(at.start.xy * power_of_two(-at.level))), ivec2(0),
                  ivec2((box.grid.y >> at.level) - 1));
  at.divisions = 0;
  at.first_part = 0;
  at.entry = at.entry_end = 0u;
  return at;
}

void traversal_save(Traversal at, uint word) {
  put_word(word, uint(at.level + 16) | (at.alive ? 256u : 0u) | uint(at.divisions) << 16u);
  put_word(word + 1u, uint(at.cell.x));
  put_word(word + 2u, uint(at.cell.y));
  put_word(word + 3u, uint(at.first_part));
  put_word(word + 4u, floatBitsToUint(at.s));
  put_word(word + 5u, floatBitsToUint(at.s_end));
  put_word(word + 6u, at.entry);
  put_word(word + 7u, at.entry_end);
}

#if RESUMED
Traversal traversal_load(Ray ray, uint word) {
  Traversal at = traversal_begin(ray);
  uint bits = get_word(word);
  at.level = int(bits & 255u) - 16;
  at.alive = (bits & 256u) != 0u;
  at.divisions = int(bits >> 16u);
  at.cell = ivec2(get_word(word + 1u), get_word(word + 2u));
  at.first_part = int(get_word(word + 3u));
  at.s = uintBitsToFloat(get_word(word + 4u));
  at.s_end = uintBitsToFloat(get_word(word + 5u));
  at.depth = at.start.z + at.s * at.direction.z;
  at.entry = get_word(word + 6u);
  at.entry_end = get_word(word + 7u);
  return at;
}
#endif

// What a ray found in a node that lists triangles.
struct Found {
  bool any;
  uvec2 node;       // its z and w
  uvec2 depths;     // of the ray in it
  uint number;
};

// One cell: goes down into it where it holds something at the ray's depths, or finds its list, and
// goes on to its neighbour otherwise.
Found step_cell(inout Traversal at) {
  COUNT_STEP
  // Where the ray leaves the cell. Boundaries are computed from whole numbers, so that errors do not
  // add up.
  float size = power_of_two(at.level);
  vec2 boundary = (vec2(at.cell) + at.far_side) * size;
  vec2 to_boundary = (boundary - at.start.xy) * at.inverse.xy;
  bool through_x = to_boundary.x <= to_boundary.y;
  float s_out = through_x ? to_boundary.x : to_boundary.y;
  float s_next = s_out > at.s ? s_out : at.s;
  float depth_next = at.start.z + (s_next < at.s_end ? s_next : at.s_end) * at.direction.z;
  bool rising = depth_next > at.depth;
  uint low = depth_code((rising ? at.depth : depth_next) - box.depth.y);
  uint high = depth_code((rising ? depth_next : at.depth) + box.depth.y);

  int parts = max(-at.level, 0), side = box.grid.y >> max(at.level, 0), within = (1 << parts) - 1;
  int index = at.level >= 0
                  ? level_start(side) + side * at.cell.y + at.cell.x
                  : at.first_part + ((at.cell.y & within) << parts) + (at.cell.x & within);
  uvec4 node = texelFetch(nodes, index);
  uvec2 met = node.xy & mask_between(low >> MASK_SHIFT, high >> MASK_SHIFT);
  bool hit = (met.x | met.y) != 0u;
  if (at.level == 0) {
    at.divisions = int(node.w & NODE_LEVELS);
    at.first_part = int(node.z);
  }
  bool leaf = at.level <= 0 && at.level == -at.divisions;
  Found found = Found(hit && leaf, node.zw, uvec2(low, high), uint(index));

  // Down to the child that holds the ray at s, several levels at once.
  bool down = hit && !leaf;
  int levels_down = at.level > 0 ? min(STRIDE, at.level) : at.divisions;
  ivec2 corner = at.cell << levels_down;
  vec2 place = (at.start.xy + at.s * at.direction.xy) * power_of_two(levels_down - at.level);
  ivec2 child = clamp(ivec2(floor(place)), corner, corner + (1 << levels_down) - 1);
  // On to the neighbour, and up where that has another parent.
  ivec2 neighbour = at.cell + (through_x ? ivec2(at.turn.x, 0) : ivec2(0, at.turn.y));
  int levels_up = at.level >= 0 ? min(STRIDE, box.grid.z - at.level) : parts;
  ivec2 changed = (neighbour ^ at.cell) >> levels_up;
  if ((changed.x | changed.y) == 0) levels_up = 0;
  uint limit = uint(side << parts);
  at.alive = down || (s_next < at.s_end && uint(neighbour.x) < limit && uint(neighbour.y) < limit);
  at.cell = down ? child : neighbour >> levels_up;
  at.level = down ? at.level - levels_down : at.level + levels_up;
  at.s = down ? at.s : s_next;
  at.depth = down ? at.depth : depth_next;
  return found;
}

// The run of triangles that the ray passes in a node. It begins one bucket early, since a triangle
// stands in every second bucket only (sort_lists.comp).
void open_list(Found found, inout Traversal at) {
  ivec2 buckets = ivec2(found.depths >> (found.node.y >> NODE_SHIFT & 31u)) -
                  int(found.node.y >> NODE_FIRST);
  int last = int(found.node.y >> NODE_BUCKETS & 255u);
  if (!found.any || buckets.x > last + 1 || buckets.y < 0) return;
  at.entry = texelFetch(offsets, int(found.node.x) + max(buckets.x - 1, 0)).x;
  at.entry_end = texelFetch(offsets, int(found.node.x) + min(buckets.y, last) + 1).x;
  COUNT_LIST(found.number, at.entry_end - at.entry)
}

#if ANY_HIT
#define MET_ENDS && hit.primitive == NO_PRIMITIVE
#else
#define MET_ENDS
#endif

bool traverse(Ray ray, inout Traversal at, inout TracedHit hit, int budget) {
  while ((at.alive || at.entry < at.entry_end) && budget > 0) {
    Found found = Found(false, uvec2(0u), uvec2(0u), 0u);
    while (at.alive && !found.any && at.entry >= at.entry_end && budget > 0) {
      found = step_cell(at);
      --budget;
    }
    open_list(found, at);

    uint stop = min(at.entry_end, at.entry + uint(max(budget, 0)));
    budget -= int(stop - at.entry);
    while (at.entry < stop MET_ENDS) {
      intersect(ray, texelFetch(ids, int(at.entry)).x, hit);
      ++at.entry;
    }
#if ANY_HIT
    if (hit.primitive != NO_PRIMITIVE) return true;
#endif
    float s_hit = end_of(hit.t, at);
    at.s_end = s_hit < at.s_end ? s_hit : at.s_end;
    at.alive = at.alive && at.s <= at.s_end;
  }
  return !at.alive && at.entry >= at.entry_end;
}
