// Normals that node trees change.

// Turns `n` towards the geometric normal until the mirrored view direction leaves the surface: no
// normal, mapped or interpolated, may reflect what is below the horizon (Cycles corrects every
// closure's normal so). In the plane of `n` and `ng`, with the angle a taken from ng, the mirrored
// direction's height is Ix sin 2a + Iz cos 2a; it is set to the threshold and solved for a.
vec3 keep_reflection_above(vec3 ng, vec3 v, vec3 n) {
  float height = dot(ng, v);
  float threshold = min(0.9 * height, 0.01);
  vec3 mirrored = 2.0 * dot(n, v) * n - v;
  if (dot(ng, mirrored) >= threshold) return n;
  vec3 x = n - dot(n, ng) * ng;
  float sine = length(x);
  if (sine < 1.0e-6) return ng;
  x /= sine;
  float ix = dot(v, x);
  float amplitude = sqrt(ix * ix + height * height);
  if (amplitude < 1.0e-12) return ng;
  float angle = 0.5 * (atan(ix, height) + acos(clamp(threshold / amplitude, -1.0, 1.0)));
  return sin(angle) * x + cos(angle) * ng;
}

vec3 finish_normal_map(Hit hit, vec3 n, float strength) {
  if (hit.backfacing) n = -n;
  n = safe_normalize(n, hit.normal);
  return safe_normalize(mix(hit.normal, n, max(strength, 0.0)), hit.normal);
}

// Normals between object and world space: as far as directions go, whatever the scale.
vec3 normal_to_object(mat3 linear, vec3 n) { return safe_normalize(transpose(linear) * n, n); }
vec3 normal_to_world(mat3 linear, vec3 n) {
  return safe_normalize(cofactors(linear) * n * determinant_sign(linear), n);
}
vec3 direction_to_object(mat3 linear, vec3 v) {
  return transpose(cofactors(linear)) * v * determinant_sign(linear);
}

// The direction in which the first texture coordinate grows, object space, square to `n`.
vec3 tangent_of_edges(Hit hit, mat3 linear, vec3 n, vec2 d1, vec2 d2) {
  float orientation = d1.x * d2.y - d1.y * d2.x < 0.0 ? -1.0 : 1.0;
  vec3 t = direction_to_object(linear, (hit.edge1 * d2.y - hit.edge2 * d1.y) * orientation);
  // Coordinates without an area give no direction; Cycles then takes the X axis.
  if (d1.x * d2.y == d1.y * d2.x) t = vec3(1.0, 0.0, 0.0);
  t = safe_normalize(t, vec3(0.0));
  return safe_normalize(t - n * dot(n, t), vec3(0.0));
}

// As Cycles has it: the tangent goes to world space like a normal.
vec3 uv_tangent(Hit hit, int uv_attribute) {
  vec2 d1, d2;
  if (!uv_edges(hit, uv_attribute, d1, d2)) return vec3(0.0);
  mat3 linear = fetch_transform(hit.instance, vec3(0.0)).linear;
  vec3 n = normal_to_object(linear, hit.normal_unflipped);
  return normal_to_world(linear, tangent_of_edges(hit, linear, n, d1, d2));
}

// The map is read in object space, where it was baked; the result goes on as a normal.
vec3 normal_map_tangent(Hit hit, int uv_attribute, vec3 color, float strength) {
  vec2 d1, d2;
  if (!uv_edges(hit, uv_attribute, d1, d2)) return hit.normal;
  mat3 linear = fetch_transform(hit.instance, vec3(0.0)).linear;
  vec3 n = normal_to_object(linear, hit.normal_unflipped);
  vec3 t = tangent_of_edges(hit, linear, n, d1, d2);
  vec3 b = cross(n, t) * (d1.x * d2.y - d1.y * d2.x < 0.0 ? -1.0 : 1.0);
  vec3 c = color * 2.0 - 1.0;
  return finish_normal_map(hit, normal_to_world(linear, c.x * t + c.y * b + c.z * n), strength);
}

vec3 normal_map_object(Hit hit, vec3 color, float strength) {
  mat3 linear = fetch_transform(hit.instance, vec3(0.0)).linear;
  return finish_normal_map(hit, cofactors(linear) * (color * 2.0 - 1.0) * hit.handedness, strength);
}

vec3 normal_map_world(Hit hit, vec3 color, float strength) {
  return finish_normal_map(hit, color * 2.0 - 1.0, strength);
}

// --- bumps ------------------------------------------------------------------------------------------

// Two steps of a pixel's width along the surface, square to each other; the directions are Cycles',
// so that both take differences between the same places.
vec3 bump_offset_x(Hit hit) {
  vec3 n = hit.geometric_normal;
  vec3 across = n.x != n.y || n.x != n.z ? vec3(n.z - n.y, n.x - n.z, n.y - n.x)
                                         : vec3(n.z - n.y, n.x + n.z, -n.y - n.x);
  return hit.footprint * safe_normalize(across, hit.edge1);
}

vec3 bump_offset_y(Hit hit, vec3 x) { return cross(hit.geometric_normal, x); }

// The hit moved within (or beyond) its triangle's plane, with everything that varies linearly on it.
Hit shifted_hit(Hit hit, vec3 offset) {
  vec3 normal = cross(hit.edge1, hit.edge2);
  float squared = dot(normal, normal);
  if (!(squared > 0.0)) return hit;
  float b1 = dot(cross(offset, hit.edge2), normal) / squared;
  float b2 = dot(cross(hit.edge1, offset), normal) / squared;
  hit.barycentrics += vec3(-b1 - b2, b1, b2);
  hit.position += offset;
  return hit;
}

vec3 raised_normal(vec3 n, vec3 dx, vec3 dy, vec3 heights, float distance) {
  vec3 rx = cross(dy, n), ry = cross(n, dx);
  float determinant = dot(dx, rx);
  vec3 gradient = (heights.y - heights.x) * rx + (heights.z - heights.x) * ry;
  return safe_normalize(abs(determinant) * n - distance * sign(determinant) * gradient, n);
}

// The normal of `n`'s surface raised by a height whose values here and at the two offsets are given
// (Mikkelsen 2010).
vec3 bump_normal(Hit hit, vec3 n, vec3 dx, vec3 dy, vec3 heights, float distance, float strength) {
  vec3 raised = raised_normal(n, dx, dy, heights, distance);
  return keep_reflection_above(hit.geometric_normal, hit.view,
                               safe_normalize(mix(n, raised, max(strength, 0.0)), n));
}

// A height in the object's own unit, metres.
float height_in_world(Hit hit, float height) {
  mat3 linear = fetch_transform(hit.instance, vec3(0.0)).linear;
  return height * dot(linear * normal_to_object(linear, hit.normal), hit.normal);
}
