// Volumetric obscurance (Loos and Sloan 2010; thesis 4.4.3.2): how far the line of sight through each
// point of the hemisphere is filled, from the surface's plane up to the point. Whatever stands before
// the surface counts, however far: where a lamp's light is blocked, all of it is filled.

void estimate(Place p, Face face, uint first, uint count, inout Sums sums) {
  vec3 x, y;
  frame_around(p.normal, x, y);
  for (uint i = first; i < first + count; ++i) {
    vec3 u = sequence_point(p, i);
    vec3 direction = cosine_direction(u.xy, x, y, p.normal);
    Look l = look(face, p.position, direction * r_max());
    float height = max(sqrt(1.0 - u.x), 1.0e-3) * r_max();
    sums.occlusion += l.seen ? clamp(elevation(l, p.normal) * length(l.surface) / height, 0.0, 1.0) : 0.0;
  }
  sums.count += float(count);
}
