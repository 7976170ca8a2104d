// Disks and the frames that they stand in.

// Two unit vectors square to the unit `n` and to each other, right-handed (Duff et al. 2017).
void make_frame(vec3 n, out vec3 x, out vec3 y) {
  float side = n.z >= 0.0 ? 1.0 : -1.0;
  float a = -1.0 / (side + n.z), b = n.x * n.y * a;
  x = vec3(1.0 + side * n.x * n.x * a, side * b, -side * n.x);
  y = vec3(b, side + n.y * n.y * a, -n.y);
}

// The place in the unit disk that `u` in [0, 1)^2 stands for, uniform over its area; neighbours stay
// together (Shirley and Chiu 1997).
vec2 concentric_disk(vec2 u) {
  vec2 p = 2.0 * u - 1.0;
  if (p == vec2(0.0)) return p;
  bool wide = abs(p.x) > abs(p.y);
  float r = wide ? p.x : p.y;
  float phi = wide ? 0.785398163397 * (p.y / p.x) : 1.57079632679 - 0.785398163397 * (p.x / p.y);
  return r * vec2(cos(phi), sin(phi));
}
