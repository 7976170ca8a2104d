// Closest-first traversal of a binary hierarchy of boxes, with a stack.
//
// Where rays run in lockstep without registers of their own that can be indexed (llvmpipe), a write
// to an array costs as much as the rest of a step. So the latest entries of the stack stand in
// registers that are shifted, and only what these cannot hold goes to an array, outside the loop
// over nodes.
#include "bvh_tracer/bvh_shared.h"

layout(binding = 1) uniform usamplerBuffer bvh_nodes;     // as BvhNode
layout(binding = 2) uniform samplerBuffer bvh_triangles;  // as TracedTriangle, leaf after leaf;
                                                          // `instance` is the primitive instead

// No child: the search is over, or this place of the stack is empty.
const int BVH_NONE = int(0x80000000);
const uint TRAVERSAL_WORDS = 10u + BVH_DEPTH;

struct Traversal {
  int node;          // the child to visit next, or BVH_NONE
  uint first, end;   // triangles of a leaf that are still to be tested
  ivec3 top, below;  // of the stack: the latest six entries, the latest first; else BVH_NONE
  int height;        // entries of the stack that are in bvh_stack
};
// Of the one ray that is under way.
int bvh_stack[BVH_DEPTH];

Traversal traversal_begin(Ray ray) {
  return Traversal(0, 0u, 0u, ivec3(BVH_NONE), ivec3(BVH_NONE), 0);
}

void traversal_save(Traversal at, uint word) {
  put_word(word, uint(at.node));
  put_word(word + 1u, at.first);
  put_word(word + 2u, at.end);
  for (int i = 0; i < 3; ++i) put_word(word + 3u + uint(i), uint(at.top[i]));
  for (int i = 0; i < 3; ++i) put_word(word + 6u + uint(i), uint(at.below[i]));
  put_word(word + 9u, uint(at.height));
  for (int i = 0; i < at.height; ++i) put_word(word + 10u + uint(i), uint(bvh_stack[i]));
}

#if RESUMED
Traversal traversal_load(Ray ray, uint word) {
  Traversal at;
  at.node = int(get_word(word));
  at.first = get_word(word + 1u);
  at.end = get_word(word + 2u);
  for (int i = 0; i < 3; ++i) at.top[i] = int(get_word(word + 3u + uint(i)));
  for (int i = 0; i < 3; ++i) at.below[i] = int(get_word(word + 6u + uint(i)));
  at.height = int(get_word(word + 9u));
  for (int i = 0; i < at.height; ++i) bvh_stack[i] = int(get_word(word + 10u + uint(i)));
  return at;
}
#endif

int leaf_of(uint first, uint count) { return ~int(first << BVH_COUNT_BITS | count); }

// The children of node `number`, as BvhNode says.
ivec2 children_of(int number, uint grid, uint other) {
  uint code0 = (grid >> 24u) & 15u, code1 = grid >> 28u;
  uint first1 = code0 == 0u ? other : other + code0 - 1u;
  return ivec2(code0 == 0u ? number + 1 : leaf_of(other, code0 - 1u),
               code1 != 0u ? leaf_of(first1, code1 - 1u) : code0 == 0u ? int(other) : number + 1);
}

// One over the direction, without infinities: no product with it may become NaN. A component that is
// none becomes one by which a ray leaves the room around a box only beyond all that it can meet.
vec3 inverse_direction(vec3 direction) {
  vec3 size = abs(direction);
  float least = max(max(size.x, max(size.y, size.z)) * 8.7e-19, 7.9e-31);
  return 1.0 / mix(direction, vec3(least), lessThan(size, vec3(least)));
}

// Where a ray meets pairs of planes: x where the later of them was entered, y where the first was
// left, within the limits. Integers order the floats from 0 on as floats do, in a third of the
// instructions; those below 0 come before these, which is all that has to be known of them.
ivec2 overlap(vec3 planes0, vec3 planes1, int nearest, int farthest) {
  ivec3 a = floatBitsToInt(planes0), b = floatBitsToInt(planes1);
  ivec3 entered = min(a, b), left = max(a, b);
  return ivec2(max(max(entered.x, entered.y), max(entered.z, nearest)),
               min(min(left.x, left.y), min(left.z, farthest)));
}

bool traverse(Ray ray, inout Traversal at, inout TracedHit hit, int budget) {
  vec3 inverse = inverse_direction(ray.direction);
  int nearest = floatBitsToInt(ray.t_min);

  while (at.node != BVH_NONE || at.first < at.end) {
    // Down to a leaf, while there is room for another entry of the stack.
    int farthest = floatBitsToInt(hit.t);
    while (at.node >= 0 && at.below.z == BVH_NONE && budget > 0) {
      COUNT_STEP
      --budget;
      uvec4 texel0 = texelFetch(bvh_nodes, at.node * 2);
      uvec4 texel1 = texelFetch(bvh_nodes, at.node * 2 + 1);
      uvec3 planes = texel1.xyz;
      vec3 start = (uintBitsToFloat(texel0.xyz) - ray.origin) * inverse;
      uvec3 exponents = (uvec3(texel0.w) << uvec3(23u, 15u, 7u)) & 0x7f800000u;
      vec3 spacing = uintBitsToFloat(exponents) * inverse;
      ivec2 span0 = overlap(vec3(planes & 255u) * spacing + start,
                            vec3((planes >> 8u) & 255u) * spacing + start, nearest, farthest);
      ivec2 span1 = overlap(vec3((planes >> 16u) & 255u) * spacing + start,
                            vec3(planes >> 24u) * spacing + start, nearest, farthest);
      // Sixteen steps of the last bit: more than has been rounded here and in a triangle's test
      // (Ize 2013).
      bool meets0 = span0.x <= span0.y + 16, meets1 = span1.x <= span1.y + 16;
      bool both = meets0 && meets1, any = meets0 || meets1;
      bool swapped = meets1 && (!meets0 || span1.x < span0.x);
      ivec2 children = children_of(at.node, texel0.w, texel1.w);
      at.node = any ? (swapped ? children.y : children.x) : at.top.x;
      int farther = swapped ? children.x : children.y;
      ivec3 top = at.top, below = at.below;
      at.top = both ? ivec3(farther, top.xy) : any ? top : ivec3(top.yz, below.x);
      at.below = both ? ivec3(top.z, below.xy) : any ? below : ivec3(below.yz, BVH_NONE);
    }
    if (at.node < 0 && at.node != BVH_NONE && at.first >= at.end) {
      uint leaf = uint(~at.node);
      at.first = leaf >> BVH_COUNT_BITS;
      at.end = at.first + (leaf & ((1u << BVH_COUNT_BITS) - 1u));
      COUNT_LIST(at.first, at.end - at.first)
      at.node = at.top.x;
      at.top = ivec3(at.top.yz, at.below.x);
      at.below = ivec3(at.below.yz, BVH_NONE);
    }
    if (at.below.z != BVH_NONE) {
      bvh_stack[at.height] = at.below.z;
      bvh_stack[at.height + 1] = at.below.y;
      at.height += 2;
      at.below.yz = ivec2(BVH_NONE);
    }
    if (at.node == BVH_NONE && at.height > 0) {
      at.height -= 2;
      at.node = bvh_stack[at.height + 1];
      at.top.x = bvh_stack[at.height];
    }
    while (at.first < at.end && budget > 0) {
      --budget;
      int i = int(at.first) * 3;
      vec4 texel0 = texelFetch(bvh_triangles, i), texel1 = texelFetch(bvh_triangles, i + 1),
           texel2 = texelFetch(bvh_triangles, i + 2);
      Corners corners = Corners(texel0.xyz, texel1.xyz, texel2.xyz, floatBitsToUint(texel2.w));
      intersect_corners(ray, floatBitsToUint(texel0.w), corners, hit);
      ++at.first;
    }
#if ANY_HIT
    if (hit.primitive != NO_PRIMITIVE) return true;
#endif
    if (budget <= 0) return at.node == BVH_NONE && at.first >= at.end;
  }
  return true;
}
