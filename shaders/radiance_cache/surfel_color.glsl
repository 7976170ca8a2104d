// What a surface reflects, 0 .. 1 each, in ten bits of its square root: dark colours keep their hue.
uint pack_color(vec3 color) {
  uvec3 steps = uvec3(sqrt(clamp(color, 0.0, 1.0)) * 1023.0 + 0.5);
  return steps.x | steps.y << 10 | steps.z << 20;
}

vec3 unpack_color(uint word) {
  vec3 root = vec3(word & 1023u, word >> 10 & 1023u, word >> 20 & 1023u) / 1023.0;
  return root * root;
}
