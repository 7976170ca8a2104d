// Reflectance of smooth surfaces.

// Of clear coats.
const float COAT_IOR = 1.5;

float reflectance_from_ior(float ior) {
  float r = (ior - 1.0) / (ior + 1.0);
  return r * r;
}

// Unpolarised reflectance of a dielectric; `ior` is that of the far side over that of the near side.
float fresnel_dielectric(float cosine, float ior) {
  float c = abs(cosine);
  float square = ior * ior - 1.0 + c * c;
  if (square <= 0.0) return 1.0;  // total internal reflection
  float g = sqrt(square);
  float a = (g - c) / (g + c);
  float b = ((g + c) * c - 1.0) / ((g - c) * c + 1.0);
  return 0.5 * a * a * (1.0 + b * b);
}

// How far the reflectance has risen from that at normal incidence (0) to that at grazing angles (1).
float fresnel_rise(float cosine, float ior) {
  float f0 = reflectance_from_ior(ior);
  return clamp((fresnel_dielectric(cosine, ior) - f0) / max(1.0 - f0, 1.0e-6), 0.0, 1.0);
}
