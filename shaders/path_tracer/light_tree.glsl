// One of many lights by its estimated contribution to a place (Conty Estevez and Kulla 2018): a walk
// down a tree whose nodes bound where their lights are, how strong they are and where they shine.
#include "base/packing.glsl"
#include "path_tracer/lights_shared.h"

layout(binding = 1) uniform usamplerBuffer light_nodes;  // as LightNode

// Lobes may have normals of their own, which see lights that are below the horizon of the surface's:
// what the receiver's cosine is at least.
const float LEAST_COSINE = 0.03125;

uvec4 node_texel(int node, int i) { return texelFetch(light_nodes, node * NODE_TEXELS + i); }

// The cosine of the angle a - b, of 0 where b is greater. Angles from 0 to pi, by sine and cosine.
float cosine_of_rest(float sine_a, float cosine_a, float sine_b, float cosine_b) {
  return cosine_a > cosine_b ? 1.0 : cosine_a * cosine_b + sine_a * sine_b;
}
float sine_of_rest(float sine_a, float cosine_a, float sine_b, float cosine_b) {
  return cosine_a > cosine_b ? 0.0 : sine_a * cosine_b - cosine_a * sine_b;
}
float sine_of(float cosine) { return sqrt(max(1.0 - cosine * cosine, 0.0)); }

// The receiver's cosine for light from `direction`, or from as far off as the angle b.
float receiver_cosine(vec3 normal, vec3 direction, float sine_b, float cosine_b) {
  float cosine = dot(normal, direction);
  return max(cosine_of_rest(sine_of(cosine), cosine, sine_b, cosine_b), LEAST_COSINE);
}

// About the mean of 1 / distance^2 over a ball of that squared radius whose centre is so far off: within
// 4 % of the exact mean.
float mean_inverse_square(float distance2, float radius2) {
  if (distance2 < radius2) return (3.0 - 1.5 * distance2 / radius2) / max(radius2, 1.0e-30);
  float ratio = radius2 / max(distance2, 1.0e-30);
  return (1.0 + 0.5 * ratio * ratio) / max(distance2, 1.0e-30);
}

// About the irradiance that what is below `node` gives at `from`, W/m2; 0 only where there is none. And
// LightNode.child of it.
float node_importance(int node, vec3 from, vec3 normal, out uint child) {
  uvec4 words0 = node_texel(node, 0), words1 = node_texel(node, 1), words2 = node_texel(node, 2);
  child = words1.w;
  vec3 axis = unpack_unit(words2.x);
  float intensity = uintBitsToFloat(words0.w);
  float cosine_o = uintBitsToFloat(words2.y), sine_o = sine_of(cosine_o);
  bool received = normal != vec3(0.0);
#if LIGHT_SUNS
  if ((child & NODE_INFINITE) != 0u)
    return received ? intensity * receiver_cosine(normal, -axis, sine_o, cosine_o) : intensity;
#endif
  vec3 low = uintBitsToFloat(words0.xyz), high = uintBitsToFloat(words1.xyz);
  vec3 to_center = 0.5 * low + 0.5 * high - from;
  vec3 half_size = 0.5 * (high - low);
  float radius2 = dot(half_size, half_size), distance2 = dot(to_center, to_center);
  // The sphere about the bounds, as an angle that it takes of the receiver's view.
  float sine_b = 0.0, cosine_b = -1.0;
  if (distance2 > radius2) {
    sine_b = sqrt(radius2 / distance2);
    cosine_b = sqrt(1.0 - radius2 / distance2);
  }
  vec3 direction = to_center * inversesqrt(max(distance2, 1.0e-30));
  float cosine = -dot(axis, direction);
  if ((child & NODE_TWO_SIDED) != 0u) cosine = abs(cosine);
  float sine = sine_of(cosine);
  float cosine_x = cosine_of_rest(sine, cosine, sine_o, cosine_o);
  float sine_x = sine_of_rest(sine, cosine, sine_o, cosine_o);
  float emitted = cosine_of_rest(sine_x, cosine_x, sine_b, cosine_b);
  if (emitted <= uintBitsToFloat(words2.z)) return 0.0;
  // A cube has the volume of a ball of half its own half diagonal, squared.
  float importance = intensity * emitted * mean_inverse_square(distance2, 0.5 * radius2);
  if (received) importance *= receiver_cosine(normal, direction, sine_b, cosine_b);
  return min(importance, 1.0e30);
}

// The same of all lights.
float tree_importance(vec3 from, vec3 normal) {
  uint child;
#if LIGHT_SUNS && LIGHT_LOCAL
  // The root's children are what is somewhere and what is nowhere.
  int second = int(node_texel(0, 1).w & NODE_INDEX);
  return node_importance(1, from, normal, child) + node_importance(second, from, normal, child);
#else
  return node_importance(0, from, normal, child);
#endif
}

// The two ways on from a node.
struct Fork {
  int first, second;
  uint first_child, second_child;  // LightNode.child of these
  float share;  // of the first; below 0 if there is no light
};

Fork fork_at(int node, uint child, vec3 from, vec3 normal) {
  Fork f;
  f.first = node + 1;
  f.second = int(child & NODE_INDEX);
  float first = node_importance(f.first, from, normal, f.first_child);
  float sum = first + node_importance(f.second, from, normal, f.second_child);
  f.share = sum > 0.0 ? first / sum : -1.0;
  return f;
}

// A record by chance, `random` in [0, 1), and its probability; NO_LIGHT where none shines.
uint choose_light(vec3 from, vec3 normal, float random, out float probability) {
  probability = 1.0;
  int node = 0;
  uint child = node_texel(0, 1).w;
  for (int level = 0; level < MOST_LEVELS && (child & NODE_LEAF) == 0u; ++level) {
    Fork f = fork_at(node, child, from, normal);
    if (f.share < 0.0) return NO_LIGHT;
    bool first = random < f.share;
    float share = first ? f.share : 1.0 - f.share;
    random = min((first ? random : random - f.share) / share, 0.99999994);
    probability *= share;
    node = first ? f.first : f.second;
    child = first ? f.first_child : f.second_child;
  }
  return child & NODE_INDEX;
}

// The probability with which choose_light() comes to the leaf that `trail` leads to.
float light_probability(uint trail, vec3 from, vec3 normal) {
  float probability = 1.0;
  int node = 0;
  uint child = node_texel(0, 1).w;
  for (int level = 0; level < MOST_LEVELS && (child & NODE_LEAF) == 0u; ++level, trail >>= 1) {
    Fork f = fork_at(node, child, from, normal);
    if (f.share < 0.0) return 0.0;
    bool first = (trail & 1u) == 0u;
    probability *= first ? f.share : 1.0 - f.share;
    node = first ? f.first : f.second;
    child = first ? f.first_child : f.second_child;
  }
  return probability;
}
