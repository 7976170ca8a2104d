// A Surface that keeps, of all closures of a kind, one as it is: by chance, in proportion to how much
// light each reflects, and scaled by the inverse of that chance, so that the mean over many seeds is
// the sum of all (reservoir sampling). closures.glsl has the Surface, and who evaluates a material
// sets its seed. Closures that differ in colour alone are added up instead.

void empty_lobes(inout Surface s) {
  s.seed = 0u;
  s.diffuse_roughness = LAMBERT;
  s.ior = 1.0;
  s.diffuse_normal = s.specular_normal = s.transmission_normal = s.sheen_normal = vec3(0.0);
}

// Only as a closure leaves it may a normal reflect what is below the horizon.
vec3 lobe_normal(Hit hit, vec3 normal) {
  return keep_reflection_above(hit.geometric_normal, hit.view, safe_normalize(normal, hit.normal));
}

void finish_lobes(Hit hit, inout Surface s) {
  s.diffuse_normal = lobe_normal(hit, s.diffuse_normal);
  s.diffuse_roughness = clamp(finite(s.diffuse_roughness), LAMBERT - 1.0, 1.0);
#if GLOSSY
  s.specular_normal = lobe_normal(hit, s.specular_normal);
  s.specular_ior = finite(s.specular_ior);
  s.roughness = clamp(finite(s.roughness), 0.0, 1.0);
#endif
#if TRANSMISSION
  s.transmission_normal = lobe_normal(hit, s.transmission_normal);
  s.transmission_roughness = clamp(finite(s.transmission_roughness), 0.0, 1.0);
  s.ior = finite(s.ior);
#endif
#if LAYERS
  s.coat_normal = lobe_normal(hit, s.coat_normal);
  s.coat_roughness = clamp(finite(s.coat_roughness), -1.0, 1.0);
  s.sheen_normal = lobe_normal(hit, s.sheen_normal);
  s.sheen_roughness = clamp(finite(s.sheen_roughness), SHEEN_SCHLICK, 1.0);
#endif
}

// Factors of the lobe that is held and of one that comes, by what they reflect; one of both is 0.
vec2 choose(inout uint seed, float held, float coming) {
  if (held == 0.0) return vec2(0.0, 1.0);
  if (!(coming > 0.0 && coming < 1.0e30)) return vec2(1.0, 0.0);
  seed = hash(seed);
  float chance = coming / (held + coming);
  return unit_float(seed) < chance ? vec2(0.0, 1.0 / chance) : vec2(1.0 / (1.0 - chance), 0.0);
}

void add_diffuse(inout Surface s, vec3 albedo, float roughness, vec3 normal) {
  vec2 factors = vec2(1.0);
  if (roughness != s.diffuse_roughness || normal != s.diffuse_normal)
    factors = choose(s.seed, luminance(abs(s.diffuse)), luminance(abs(albedo)));
  s.diffuse = s.diffuse * factors.x + albedo * factors.y;
  if (factors.y == 0.0) return;
  s.diffuse_roughness = roughness;
  s.diffuse_normal = normal;
}

void add_burley(inout Surface s, vec3 albedo, float roughness, vec3 normal) {
  add_diffuse(s, albedo, clamp(roughness, 0.0, 1.0), normal);
}

void add_oren_nayar(inout Surface s, vec3 albedo, float roughness, vec3 normal) {
  add_diffuse(s, albedo, LAMBERT - clamp(roughness, 0.0, 1.0), normal);
}

// `ior` of 1: reflects alike at all angles.
void add_specular(inout Surface s, vec3 normal_incidence, vec3 grazing, float ior, float roughness,
                  vec3 normal) {
  vec2 factors = vec2(1.0);
  if (roughness != s.roughness || ior != s.specular_ior || normal != s.specular_normal)
    factors = choose(s.seed, specular_amount(s.specular, s.grazing),
                     specular_amount(normal_incidence, grazing));
  s.specular = s.specular * factors.x + normal_incidence * factors.y;
  s.grazing = s.grazing * factors.x + grazing * factors.y;
  if (factors.y == 0.0) return;
  s.specular_ior = ior;
  s.roughness = roughness;
  s.specular_normal = normal;
}

void add_transmission(inout Surface s, vec3 amount, float ior, float roughness, vec3 normal) {
  vec2 factors = vec2(1.0);
  if (roughness != s.transmission_roughness || ior != s.ior || normal != s.transmission_normal)
    factors = choose(s.seed, luminance(abs(s.transmission)), luminance(abs(amount)));
  s.transmission = s.transmission * factors.x + amount * factors.y;
  if (factors.y == 0.0) return;
  s.ior = ior;
  s.transmission_roughness = roughness;
  s.transmission_normal = normal;
}

void add_coat(inout Surface s, float amount, float roughness, vec3 normal) {
  vec2 factors = vec2(1.0);
  if (roughness != s.coat_roughness || normal != s.coat_normal)
    factors = choose(s.seed, abs(s.coat), abs(amount));
  s.coat = s.coat * factors.x + amount * factors.y;
  if (factors.y == 0.0) return;
  s.coat_roughness = roughness;
  s.coat_normal = normal;
}

void add_sheen(inout Surface s, vec3 amount, float roughness, vec3 normal) {
  vec2 factors = vec2(1.0);
  if (roughness != s.sheen_roughness || normal != s.sheen_normal)
    factors = choose(s.seed, luminance(abs(s.sheen)), luminance(abs(amount)));
  s.sheen = s.sheen * factors.x + amount * factors.y;
  if (factors.y == 0.0) return;
  s.sheen_roughness = roughness;
  s.sheen_normal = normal;
}
