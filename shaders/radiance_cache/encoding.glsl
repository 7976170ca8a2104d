// How a cell keeps the radiance that arrives there: spherical harmonics of luminance and of the two
// chrominances, which are cut off earlier (thesis, section 5.4), or of red, green and blue.
//
// A program defines RGB (0, 1) and the number of coefficients of luminance and of a chrominance,
// LUMINANCE_TERMS and CHROMINANCE_TERMS (1, 4 or 9; of each colour, both the same). A cell has
// CELL_TEXELS texels with the coefficients one after the other and then its seed (cells.glsl).
#include "base/spherical_harmonics.glsl"

#define COEFFICIENTS (LUMINANCE_TERMS + 2 * CHROMINANCE_TERMS)
#define CELL_TEXELS ((COEFFICIENTS + 4) / 4)
#define COEFFICIENT(texels, i) texels[(i) / 4][(i) % 4]

// (5.6) and back; linear.
vec3 ycocg_from_rgb(vec3 c) {
  return vec3(0.25 * c.r + 0.5 * c.g + 0.25 * c.b, 0.5 * c.r - 0.5 * c.b,
              -0.25 * c.r + 0.5 * c.g - 0.25 * c.b);
}

vec3 rgb_from_ycocg(vec3 c) { return vec3(c.x + c.y - c.z, c.x + c.z, c.x - c.y - c.z); }

// The texels of a cell that radiance with these coefficients arrives at.
vec4[CELL_TEXELS] encode(vec3 harmonics[9], float seed) {
  vec4 texels[CELL_TEXELS];
  for (int i = 0; i < CELL_TEXELS; ++i) texels[i] = vec4(0.0);
  for (int k = 0; k < LUMINANCE_TERMS; ++k) {
#if RGB
    vec3 c = harmonics[k];
#else
    vec3 c = ycocg_from_rgb(harmonics[k]);
#endif
    COEFFICIENT(texels, k) = c.x;
    if (k < CHROMINANCE_TERMS) {
      COEFFICIENT(texels, LUMINANCE_TERMS + k) = c.y;
      COEFFICIENT(texels, LUMINANCE_TERMS + CHROMINANCE_TERMS + k) = c.z;
    }
  }
  COEFFICIENT(texels, COEFFICIENTS) = seed;
  return texels;
}

// The colour of luminance `c.x` and chrominances `c.yz`, less of these where it would be negative: a
// chrominance that was cut off early may be too strong where luminance is low.
vec3 rgb_in_gamut(vec3 c) {
  vec3 offset = rgb_from_ycocg(vec3(0.0, c.yz));
  float lowest = min(offset.r, min(offset.g, offset.b));
  return c.x + offset * (lowest < 0.0 ? clamp(-c.x / lowest, 0.0, 1.0) : 1.0);
}

// The sum over all harmonics of what is stored times `weights`. May be below 0 where harmonics ring.
vec3 decode(vec4 texels[CELL_TEXELS], float weights[9]) {
  vec3 sum = vec3(0.0);
  for (int k = 0; k < LUMINANCE_TERMS; ++k) {
    sum.x += COEFFICIENT(texels, k) * weights[k];
    if (k < CHROMINANCE_TERMS) {
      sum.y += COEFFICIENT(texels, LUMINANCE_TERMS + k) * weights[k];
      sum.z += COEFFICIENT(texels, LUMINANCE_TERMS + CHROMINANCE_TERMS + k) * weights[k];
    }
  }
#if !RGB
#if CHROMINANCE_TERMS == 1
  // One chrominance for all directions: of what little light there is from where it is dark, too. The
  // thesis adds it to any luminance, which takes colour from a floor under a blue sky; here all
  // directions have the mean's hue.
  float mean = COEFFICIENT(texels, 0) * weights[0];
  sum.yz *= mean > 0.0 ? max(sum.x, 0.0) / mean : 0.0;
#endif
  sum = rgb_in_gamut(sum);
#endif
  return sum;
}
