// One of many lights by its estimated contribution to a place (Conty Estevez and Kulla 2018): a walk
// down a tree whose nodes bound where their lights are, how strong they are and where they shine.
#include "base/packing.glsl"
#include "path_tracer/lights_shared.h"

layout(binding = 1) uniform usamplerBuffer light_nodes;  // as LightNode

// Lobes may have normals of their own, which see lights that are below the horizon of the surface's:
// what the receiver's cosine is at least.
const float LEAST_COSINE = 0.03125;

uvec4 node_texel(int node, int i) { return texelFetch(light_nodes, node * NODE_TEXELS + i); }
uint node_child(int node) { return node_texel(node, 1).w; }

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

// About the irradiance that what is below `node` gives at `from`, W/m2. 0 only where there is none.
float node_importance(int node, vec3 from, vec3 normal) {
  uvec4 words0 = node_texel(node, 0), words1 = node_texel(node, 1), words2 = node_texel(node, 2);
  vec3 axis = unpack_unit(words2.x);
  float intensity = uintBitsToFloat(words0.w);
  float cosine_o = uintBitsToFloat(words2.y), sine_o = sine_of(cosine_o);
  bool received = normal != vec3(0.0);
#if LIGHT_SUNS
  if ((words1.w & NODE_INFINITE) != 0u)
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
  if ((words1.w & NODE_TWO_SIDED) != 0u) cosine = abs(cosine);
  float sine = sine_of(cosine);
  float cosine_x = cosine_of_rest(sine, cosine, sine_o, cosine_o);
  float sine_x = sine_of_rest(sine, cosine, sine_o, cosine_o);
  float emitted = cosine_of_rest(sine_x, cosine_x, sine_b, cosine_b);
  if (emitted <= uintBitsToFloat(words2.z)) return 0.0;
  float importance = intensity * emitted / max(max(distance2, radius2), 1.0e-30);
  if (received) importance *= receiver_cosine(normal, direction, sine_b, cosine_b);
  return min(importance, 1.0e30);
}

// The same of all lights.
float tree_importance(vec3 from, vec3 normal) {
#if LIGHT_SUNS && LIGHT_LOCAL
  // The root's children are what is somewhere and what is nowhere.
  return node_importance(1, from, normal) +
         node_importance(int(node_child(0) & NODE_INDEX), from, normal);
#else
  return node_importance(0, from, normal);
#endif
}

// The share of what is below `node` that its first child gets; below 0 if there is no light.
float first_share(int node, uint child, vec3 from, vec3 normal) {
  float first = node_importance(node + 1, from, normal);
  float sum = first + node_importance(int(child & NODE_INDEX), from, normal);
  return sum > 0.0 ? first / sum : -1.0;
}

// A record by chance, `random` in [0, 1), and its probability; NO_LIGHT where none shines.
uint choose_light(vec3 from, vec3 normal, float random, out float probability) {
  probability = 1.0;
  int node = 0;
  for (int level = 0; level <= MOST_LEVELS; ++level) {
    uint child = node_child(node);
    if ((child & NODE_LEAF) != 0u) return child & NODE_INDEX;
    float share = first_share(node, child, from, normal);
    if (share < 0.0) break;
    bool first = random < share;
    probability *= first ? share : 1.0 - share;
    random = min(first ? random / share : (random - share) / (1.0 - share), 0.99999994);
    node = first ? node + 1 : int(child & NODE_INDEX);
  }
  return NO_LIGHT;
}

// The probability with which choose_light() comes to the leaf that `trail` leads to.
float light_probability(uint trail, vec3 from, vec3 normal) {
  float probability = 1.0;
  int node = 0;
  for (int level = 0; level < MOST_LEVELS; ++level, trail >>= 1) {
    uint child = node_child(node);
    if ((child & NODE_LEAF) != 0u) break;
    float share = first_share(node, child, from, normal);
    if (share < 0.0) return 0.0;
    bool first = (trail & 1u) == 0u;
    probability *= first ? share : 1.0 - share;
    node = first ? node + 1 : int(child & NODE_INDEX);
  }
  return probability;
}
