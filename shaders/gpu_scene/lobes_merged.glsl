// A Surface that holds one lobe of each kind: several closures of a kind are merged, colours by sum,
// roughness and normal by weight, which is exact for a single closure and a fair approximation for a
// mix. closures.glsl has the Surface.

float quotient(float sum, float weight) { return weight > 0.0 ? finite(sum / weight) : 0.0; }

void empty_lobes(inout Surface s) {
  s.burley_weight = s.oren_nayar_weight = s.oren_nayar_roughness = 0.0;
  s.specular_weight = s.transmission_weight = s.coat_weight = s.sheen_weight = 0.0;
}

// Divides the merged quantities by their weights.
void finish_lobes(Hit hit, inout Surface s) {
  s.coat_normal = keep_reflection_above(hit.geometric_normal, hit.view,
                                        safe_normalize(s.coat_normal, hit.normal));
  // Two diffuse models do not blend: the one that reflects more stands for both.
  s.diffuse_roughness =
      s.burley_weight > s.oren_nayar_weight
          ? clamp(quotient(s.diffuse_roughness, s.burley_weight), 0.0, 1.0)
          : LAMBERT - clamp(quotient(s.oren_nayar_roughness, s.oren_nayar_weight), 0.0, 1.0);
  s.roughness = clamp(quotient(s.roughness, s.specular_weight), 0.0, 1.0);
  s.specular_ior = quotient(s.specular_ior, s.specular_weight);
  s.transmission_roughness =
      clamp(quotient(s.transmission_roughness, s.transmission_weight), 0.0, 1.0);
  s.ior = s.transmission_weight > 0.0 ? quotient(s.ior, s.transmission_weight) : 1.0;
  s.coat_roughness = clamp(quotient(s.coat_roughness, s.coat_weight), -1.0, 1.0);
  s.sheen_roughness = clamp(quotient(s.sheen_roughness, s.sheen_weight), SHEEN_SCHLICK, 1.0);
}

void add_burley(inout Surface s, vec3 albedo, float roughness, vec3 normal) {
  float amount = luminance(abs(albedo));
  s.diffuse += albedo;
  s.burley_weight += amount;
  s.diffuse_roughness += amount * roughness;
}

void add_oren_nayar(inout Surface s, vec3 albedo, float roughness, vec3 normal) {
  float amount = luminance(abs(albedo));
  s.diffuse += albedo;
  s.oren_nayar_weight += amount;
  s.oren_nayar_roughness += amount * clamp(roughness, 0.0, 1.0);
}

// `ior` of 1: reflects alike at all angles.
void add_specular(inout Surface s, vec3 normal_incidence, vec3 grazing, float ior, float roughness,
                  vec3 normal) {
  float amount = specular_amount(normal_incidence, grazing);
  s.specular += normal_incidence;
  s.grazing += grazing;
  s.specular_weight += amount;
  s.roughness += amount * roughness;
  s.specular_ior += amount * ior;
}

void add_transmission(inout Surface s, vec3 amount, float ior, float roughness, vec3 normal) {
  float weight = luminance(abs(amount));
  s.transmission += amount;
  s.transmission_weight += weight;
  s.transmission_roughness += weight * roughness;
  s.ior += weight * ior;
}

void add_coat(inout Surface s, float amount, float roughness, vec3 normal) {
  s.coat += amount;
  s.coat_weight += abs(amount);
  s.coat_roughness += abs(amount) * roughness;
  s.coat_normal += abs(amount) * normal;
}

void add_sheen(inout Surface s, vec3 amount, float roughness, vec3 normal) {
  float weight = luminance(abs(amount));
  s.sheen += amount;
  s.sheen_weight += weight;
  s.sheen_roughness += weight * roughness;
}
