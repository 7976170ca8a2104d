// Which face of a world-aligned cube of maps shows a direction: +x -x +y -y +z -z.
uint cube_face(vec3 from_light) {
  vec3 a = abs(from_light);
  if (a.x >= a.y && a.x >= a.z) return from_light.x >= 0.0 ? 0u : 1u;
  if (a.y >= a.z) return from_light.y >= 0.0 ? 2u : 3u;
  return from_light.z >= 0.0 ? 4u : 5u;
}
