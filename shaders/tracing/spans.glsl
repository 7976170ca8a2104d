// Parts of a ray, as its first and last t or what stands for it; empty where the last comes before the first.

// The part in a box; false where a ray along the box's sides lies beside it.
bool part_in_box(Ray ray, vec3 low, vec3 high, out vec2 part) {
  vec3 to_low = (low - ray.origin) / ray.direction, to_high = (high - ray.origin) / ray.direction;
  bvec3 still = equal(ray.direction, vec3(0.0));
  vec3 enter = mix(min(to_low, to_high), vec3(ray.t_min), still);
  vec3 leave = mix(max(to_low, to_high), vec3(ray.t_max), still);
  bvec3 beside = notEqual(clamp(ray.origin, low, high), ray.origin);
  part.x = max(ray.t_min, max(enter.x, max(enter.y, enter.z)));
  part.y = min(ray.t_max, min(leave.x, min(leave.y, leave.z)));
  return !(still.x && beside.x) && !(still.y && beside.y) && !(still.z && beside.z);
}

// Leaves of a part what lies where offset + s * slope is not negative.
void clip(float offset, float slope, inout vec2 part) {
  float s = -offset / slope;
  if (slope > 0.0) part.x = max(part.x, s);
  else if (slope < 0.0) part.y = min(part.y, s);
  else if (offset < 0.0) part.y = -1.0;
}
