// Rectangles as the sphere of directions about a place sees them, and directions that are evenly spread
// over that (Urena et al. 2013): near a lamp, points that are even on the lamp would be far from even in
// what they give.

struct SphericalRectangle {
  vec3 x, y, z;        // unit, along the sides and away from the place
  float x0, x1, y0, y1, z0;  // the sides in that frame, about the place
  float b0, b1, k;
  float solid_angle;
};

float corner_angle(vec3 n, vec3 m) { return acos(clamp(-dot(n, m), -1.0, 1.0)); }

// `side_x` and `side_y` are square to each other. A solid angle of 0 where there is none.
SphericalRectangle spherical_rectangle(vec3 center, vec3 side_x, vec3 side_y, vec3 from) {
  SphericalRectangle r;
  float length_x = length(side_x), length_y = length(side_y);
  r.x = side_x / length_x;
  r.y = side_y / length_y;
  r.z = cross(r.x, r.y);
  vec3 corner = center - 0.5 * (side_x + side_y) - from;
  r.z0 = dot(corner, r.z);
  if (r.z0 > 0.0) {
    r.z = -r.z;
    r.z0 = -r.z0;
  }
  r.x0 = dot(corner, r.x);
  r.y0 = dot(corner, r.y);
  r.x1 = r.x0 + length_x;
  r.y1 = r.y0 + length_y;
  // Normals of the planes through the place and each side: in two coordinates, the third is 0.
  vec3 n0 = normalize(vec3(0.0, r.z0, -r.y0)), n1 = normalize(vec3(-r.z0, 0.0, r.x1));
  vec3 n2 = normalize(vec3(0.0, -r.z0, r.y1)), n3 = normalize(vec3(r.z0, 0.0, -r.x0));
  r.b0 = n0.z;
  r.b1 = n2.z;
  r.k = 6.28318530718 - corner_angle(n2, n3) - corner_angle(n3, n0);
  r.solid_angle = corner_angle(n0, n1) + corner_angle(n1, n2) - r.k;
  if (!(r.z0 < 0.0 && r.solid_angle > 0.0)) r.solid_angle = 0.0;
  return r;
}

// The point, relative to the place, that `random` in [0, 1)^2 stands for.
vec3 sample_spherical_rectangle(SphericalRectangle r, vec2 random) {
  float angle = random.x * r.solid_angle + r.k;
  float f = (cos(angle) * r.b0 - r.b1) / sin(angle);
  float c = clamp((f > 0.0 ? 1.0 : -1.0) * inversesqrt(f * f + r.b0 * r.b0), -1.0, 1.0);
  float x = clamp(-c * r.z0 * inversesqrt(max(1.0 - c * c, 1.0e-30)), r.x0, r.x1);
  float d2 = x * x + r.z0 * r.z0;
  float h0 = r.y0 * inversesqrt(d2 + r.y0 * r.y0), h1 = r.y1 * inversesqrt(d2 + r.y1 * r.y1);
  float h = mix(h0, h1, random.y);
  float y = clamp(h * sqrt(d2) * inversesqrt(max(1.0 - h * h, 1.0e-30)), r.y0, r.y1);
  return x * r.x + y * r.y + r.z0 * r.z;
}
