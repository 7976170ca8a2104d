// Light that has reached the camera in the sample under way: one sum a path for each pass that is
// asked for, PASS_... being its number; Combined has number 0.
// Read as texels, which is faster on llvmpipe, except by programs of materials, which have no texture
// unit left.
#if SUMS_IN_STORAGE
layout(std430, binding = 6) buffer Sums { vec4 sums[]; };
#else
layout(binding = 4) uniform samplerBuffer sums_before;
layout(std430, binding = 6) writeonly buffer Sums { vec4 sums[]; };
#endif

void add_to_pass(uint path, int pass, vec3 light) {
  int i = int(path) * PASSES + pass;
#if SUMS_IN_STORAGE
  sums[i].rgb += light;
#else
  sums[i] = texelFetch(sums_before, i) + vec4(light, 0.0);
#endif
}

void set_pass(uint path, int pass, vec3 value) { sums[int(path) * PASSES + pass] = vec4(value, 0.0); }

// As Cycles clamps: by the sum of the channels' sizes, of which the limit allows three times.
vec3 clamped_light(vec3 light, uint scatterings) {
  float most = 3.0 * (scatterings > 1u ? frame.clamps.y : frame.clamps.x);
  float all = abs(light.r) + abs(light.g) + abs(light.b);
  return most > 0.0 && all > most ? light * (most / all) : light;
}

// Light that was scattered so often on its way; the shares say which lobe of the first surface
// scattered it last. Call once a program: what it adds to must not have been written before.
void add_light(uint path, vec3 light, uint scatterings, vec3 diffuse_share, vec3 glossy_share) {
#if CLAMP
  light = clamped_light(light, scatterings);
#endif
  add_to_pass(path, 0, light);
#if LIGHT_PASSES
  if (scatterings == 0u) return;
  vec3 diffuse = light * diffuse_share, glossy = light * glossy_share;
  vec3 transmission = light - diffuse - glossy;
  if (scatterings == 1u) {
#ifdef PASS_DIFFDIR
    add_to_pass(path, PASS_DIFFDIR, diffuse);
#endif
#ifdef PASS_GLOSSDIR
    add_to_pass(path, PASS_GLOSSDIR, glossy);
#endif
#ifdef PASS_TRANSDIR
    add_to_pass(path, PASS_TRANSDIR, transmission);
#endif
  } else {
#ifdef PASS_DIFFIND
    add_to_pass(path, PASS_DIFFIND, diffuse);
#endif
#ifdef PASS_GLOSSIND
    add_to_pass(path, PASS_GLOSSIND, glossy);
#endif
#ifdef PASS_TRANSIND
    add_to_pass(path, PASS_TRANSIND, transmission);
#endif
  }
#endif
}
