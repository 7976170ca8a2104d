// Horizon-based ambient occlusion (Dimitrov et al. 2008; thesis 4.4.3.1): in planes through the line
// of sight, how far up what is recorded reaches on both sides. What a plane leaves open, weighted
// by the cosine, is integrated exactly (Jimenez et al. 2016).

const float HALF_PI = 1.57079632679;

// Integrals over angles from the line of sight to `h` >= 0 on one side, where the normal leans by
// `g` to that side: x of the cosine to the normal, y and z of the direction times that along the
// line of sight and to the side; each times the sine of the angle, as planes lie closer there.
vec3 opening(float h, float g) {
  float s = sin(h), c = cos(h), sg = sin(g), cg = cos(g), s3 = s * s * s / 3.0, c3 = c * c * c / 3.0;
  return vec3(0.5 * (cg * s * s + sg * (h - s * c)), cg * (1.0 / 3.0 - c3) + sg * s3,
              cg * s3 + sg * (2.0 / 3.0 - c + c3));
}

void estimate(Place p, Face face, uint first, uint count, inout Sums sums) {
  vec3 v = towards_view(face), x, y;
  frame_around(v, x, y);
  vec3 u = sequence_point(p, first);
  // A surface that faces away is hidden by itself, and horizons above it tell nothing.
  bool away = dot(p.normal, v) <= 0.0;
  float open = 0.0, whole = 0.0;
  vec3 closed = vec3(0.0);
  int planes = count > 0u ? HBAO_SLICES / 2 : 0;
  for (int plane = 0; plane < planes; ++plane) {
    float angle = 2.0 * HALF_PI * (float(plane) + u.x) / float(HBAO_SLICES / 2);
    vec3 side = cos(angle) * x + sin(angle) * y;
    vec2 lean = vec2(dot(p.normal, side), dot(p.normal, v));
    float share = length(lean), g = atan(lean.x, lean.y);
    for (int half_plane = 0; half_plane < 2; ++half_plane) {
      float highest = -1.0;
      for (int k = 0; k < HBAO_STEPS; ++k) {
        float reach = (float(k) + fract(u.y + 0.5 * float(half_plane))) / float(HBAO_STEPS);
        Look l = look(face, p.position, side * (max(reach, 1.0 / 256.0) * r_max()));
        float squared = dot(l.surface, l.surface);
        bool near = l.seen && within(l.surface, 1.0) && elevation(l, p.normal) > 0.0;
        if (near) highest = max(highest, dot(l.surface, v) * inversesqrt(max(squared, 1.0e-30)));
        sums.hidden += l.seen && !l.hidden && !away ? 0.0 : 1.0;
        sums.unknown += l.seen && (!l.hidden || near) && !away ? 0.0 : 1.0;
      }
      // The hemisphere ends a quarter turn from the normal.
      float most = clamp(g + HALF_PI, 0.0, 2.0 * HALF_PI);
      float horizon = min(acos(clamp(highest, -1.0, 1.0)), most);
      vec3 all = opening(most, g) * share, left = opening(horizon, g) * share;
      whole += all.x;
      open += left.x;
      all -= left;
      closed += all.y * v + all.z * side;
      side = -side;
      g = -g;
    }
  }
  float samples = float(2 * planes * HBAO_STEPS);
  sums.occlusion += whole > 1.0e-6 ? samples * clamp(1.0 - open / whole, 0.0, 1.0) : 0.0;
  sums.closed += samples * closed / max(whole, 1.0e-6);
  sums.count += samples;
}
