// The interface of estimators: each looks at one view around one surface and adds to Sums.
#include "ambient_occlusion/view.glsl"
#include "base/packing.glsl"

struct Place {
  vec3 position;       // relative to the camera, metres
  vec3 normal;         // unit, towards the viewer
  uvec3 first;         // of the pixel's sequences, in 1 / 2^32
};

struct Sums {
  float occlusion;  // 0..count
  float hidden;     // samples that something stands before, or that lie outside the view
  float unknown;    // of these, the ones that tell nothing about the surface
  float distances;  // to what was looked at, each at most r_max, relative to it: the sum of (4.3)
  vec3 closed;      // directions that are blocked, by the cosine: 2/3 normal * count if all are
  float count;
};

Sums no_samples() { return Sums(0.0, 0.0, 0.0, 0.0, vec3(0.0), 0.0); }

// Point `i` of a sequence with small gaps in every range of indices: multiples of powers of a number
// that solves x^4 = x + 1 (Roberts 2018), started at another place for each pixel.
vec3 sequence_point(Place p, uint i) {
  uvec3 bits = p.first + i * uvec3(3518319153u, 2882110345u, 2360945575u);
  return vec3(bits >> 8) * (1.0 / 16777216.0);
}

// Unit vectors square to `n` (Duff et al. 2017).
void frame_around(vec3 n, out vec3 x, out vec3 y) {
  float s = n.z >= 0.0 ? 1.0 : -1.0;
  float a = -1.0 / (s + n.z), b = n.x * n.y * a;
  x = vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x);
  y = vec3(b, s + n.y * n.y * a, -n.y);
}

// A direction over `n` by the cosine; its sine to the plane is sqrt(1 - u.x).
vec3 cosine_direction(vec2 u, vec3 x, vec3 y, vec3 n) {
  float angle = 6.28318530718 * u.y;
  return sqrt(u.x) * (cos(angle) * x + sin(angle) * y) + sqrt(1.0 - u.x) * n;
}

// Sine of the elevation of what is recorded over the surface; at most 0 for the surface itself, its
// curvature and rounding.
float elevation(Look l, vec3 normal) {
  float size = max(length(l.surface), 1.0e-15);
  float sine = (dot(l.surface, normal) - l.error) / size;
  return sine > occlusion.range.w ? sine : 0.0;
}

float r_max() { return occlusion.range.x; }

// Whether `v` is shorter than so many times r_max.
bool within(vec3 v, float times) { return dot(v, v) < times * times * r_max() * r_max(); }
