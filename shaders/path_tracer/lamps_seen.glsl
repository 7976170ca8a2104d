// The lamps that a ray passes: those with an extent, found in a tree of their bounds.

// Lamps that are weighed one by one; where a ray passes more at once, one of the rest, at random, stands
// for all of these.
const uint MOST_WEIGHED = 4u;

// What of a lamp with an extent the ray sees before t_max; radiance 0 where it passes by.
Emitted lamp_on_ray(LightRecord l, vec3 from, vec3 direction, float t_max) {
  uint kind = record_kind(l);
  const Emitted NOTHING = Emitted(vec3(0.0), 0.0);
  if (kind == KIND_SUN) {
    float cosine = -dot(direction, l.axis.xyz);
    vec3 off = direction / cosine + l.axis.xyz;
    bool met = cosine > 0.0 && dot(off, off) < l.axis.w * l.axis.w;
    return met ? emitted_by_sun(l, cosine) : NOTHING;
  }
  vec3 apart = from - l.place.xyz, normal = l.axis.xyz;
  float length2 = dot(apart, apart);
  if (kind == KIND_POINT) normal = length2 > 0.0 ? apart * inversesqrt(length2) : -direction;
  float cosine = -dot(direction, normal);
  float t = dot(apart, normal) / cosine;
  if (!(cosine > 0.0 && t > 0.0 && t < t_max)) return NOTHING;
  vec3 off = apart + t * direction;
  if (is_round(kind))
    return dot(off, off) < l.axis.w * l.axis.w ? emitted_by_disk(l, kind, cosine, t * t) : NOTHING;
  // Coordinates along the sides, which a sheared lamp has not square to each other.
  float xx = dot(l.edge_x.xyz, l.edge_x.xyz), yy = dot(l.edge_y.xyz, l.edge_y.xyz);
  float xy = dot(l.edge_x.xyz, l.edge_y.xyz);
  vec2 along = vec2(dot(off, l.edge_x.xyz), dot(off, l.edge_y.xyz));
  vec2 place = vec2(along.x * yy - along.y * xy, along.y * xx - along.x * xy) / (xx * yy - xy * xy);
  bool within = kind == KIND_ELLIPSE ? dot(place, place) < 0.25 : max(abs(place.x), abs(place.y)) < 0.5;
  return within ? emitted_by_area(l, cosine, t * t) : NOTHING;
}

// False only where the ray passes by the bounds.
bool meets_bounds(uvec4 words0, uvec4 words1, vec3 from, vec3 inverse, float t_max) {
  vec3 a = (uintBitsToFloat(words0.xyz) - from) * inverse;
  vec3 b = (uintBitsToFloat(words1.xyz) - from) * inverse;
  vec3 near = min(a, b), far = max(a, b);
  float enter = max(max(near.x, near.y), max(near.z, 0.0));
  float leave = min(min(far.x, far.y), min(far.z, t_max));
  return enter <= leave * 1.00001;
}

// Radiance of one lamp, weighted.
vec3 weighed(uint light, vec3 from, vec3 normal, vec3 direction, float t_max, float scattering_pdf) {
  LightRecord l = fetch_record(light);
  Emitted e = lamp_on_ray(l, from, direction, t_max);
  if (e.radiance == vec3(0.0) || scattering_pdf <= 0.0) return e.radiance;
  // What passes through walls is for samples alone.
  if ((record_flags(l) & RECORD_SHADOWLESS) != 0u) return vec3(0.0);
#if LIGHT_AREAS
  float solid_angle = near_rectangle(l, from).solid_angle;
  if (solid_angle > 0.0) e.pdf = 1.0 / solid_angle;
#endif
  float ratio = min(e.pdf, 1.0e37) * record_probability(l, from, normal) / scattering_pdf;
  return e.radiance / (1.0 + ratio * ratio);
}

struct Passed {
  uvec4 lights;  // the first
  uint other;    // one of the rest
  uint count;
};

void pass_lamp(uint light, vec3 from, vec3 direction, float t_max, inout Passed passed) {
  if (lamp_on_ray(fetch_record(light), from, direction, t_max).radiance == vec3(0.0)) return;
  uint place = passed.count++;
  if (place < MOST_WEIGHED) {
    passed.lights[place] = light;
    return;
  }
  uint seed = floatBitsToUint(direction.x) ^ hash(floatBitsToUint(direction.y) ^ hash(light));
  if (unit_float(hash(seed)) * float(passed.count - MOST_WEIGHED) < 1.0) passed.other = light;
}

// They are weighed afterwards: llvmpipe skips no arithmetic and would walk down the tree of all lights at
// every node.
vec3 radiance_of_lamps(vec3 from, vec3 normal, vec3 direction, float t_max, float scattering_pdf) {
  Passed passed = Passed(uvec4(0u), 0u, 0u);
  vec3 inverse = 1.0 / mix(direction, vec3(1.0e-30), equal(direction, vec3(0.0)));
  uint node = light_constants.first_seen;
  while (node < light_constants.end_seen) {
    uvec4 words0 = node_texel(int(node), 0), words1 = node_texel(int(node), 1);
    bool met = meets_bounds(words0, words1, from, inverse, t_max);
    if (met && (words1.w & NODE_LEAF) != 0u)
      pass_lamp(words1.w & NODE_INDEX, from, direction, t_max, passed);
    node = met ? node + 1u : node_texel(int(node), 2).w;
  }
#if LIGHT_SUNS
  if (t_max >= FAR)
    for (uint light = 0u; light < light_constants.seen_suns; ++light)
      pass_lamp(light, from, direction, t_max, passed);
#endif
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < min(passed.count, MOST_WEIGHED + 1u); ++i) {
    bool rest = i == MOST_WEIGHED;
    vec3 radiance = weighed(rest ? passed.other : passed.lights[i], from, normal, direction, t_max,
                            scattering_pdf);
    sum += rest ? radiance * float(passed.count - MOST_WEIGHED) : radiance;
  }
  return sum;
}
