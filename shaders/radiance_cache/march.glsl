// Rays through the geometry volume, from voxel to voxel. A ray begins in volume `v` and meets nothing
// farther than `reach`, m.
#include "radiance_cache/volume.glsl"

const float MARCH_ALL = 1.0e30;  // a reach beyond everything

struct March {
  bool hit;
  int volume;
  ivec3 voxel;  // solid, where it hit
};

#if MARCH_STEPS
// As the thesis has it: so many points, spread evenly over the way (at most to the border of the volume) and
// moved by `random` (0 to 1) of their distance. Thin things between them are missed.
March march(vec3 origin, vec3 direction, int v, float random, float reach) {
  March m = March(false, v, ivec3(0));
  CacheVolume volume = cache.volumes[v];
  float side = voxel_size(volume);
  vec3 size = vec3(voxel_counts(volume));
  vec3 start = (origin - volume.low.xyz) / side;
  vec3 borders = (mix(vec3(0.0), size, greaterThan(direction, vec3(0.0))) - start) / direction;
  float end = reach / side;
  for (int i = 0; i < 3; ++i)
    if (abs(direction[i]) > 1.0e-9) end = min(end, borders[i]);
  for (int i = 0; i < MARCH_STEPS && !m.hit; ++i) {
    vec3 at = start + direction * (end * (float(i) + random) / float(MARCH_STEPS));
    m.voxel = clamp(ivec3(at), ivec3(0), voxel_counts(volume) - 1);
    m.hit = voxel_is_solid(volume, m.voxel);
  }
  return m;
}
#else
// Every voxel that the ray passes, in the finest volume that is there; where it leaves one it goes on
// in the next.
March march(vec3 origin, vec3 direction, int v, float random, float reach) {
  March m = March(false, v, ivec3(0));
  float t = 0.0;
  for (; v < cache.count.x && t < reach; ++v) {
    CacheVolume volume = cache.volumes[v];
    float side = voxel_size(volume);
    ivec3 size = voxel_counts(volume);
    vec3 start = (origin - volume.low.xyz) / side;
    vec3 speed = direction / side;
    vec3 at = start + speed * t;
    // A border between two volumes belongs to both: rounding must not end the ray there.
    ivec3 voxel = clamp(ivec3(floor(at)), ivec3(0), size - 1);
    ivec3 way = ivec3(greaterThan(direction, vec3(0.0))) * 2 - 1;
    vec3 pace = 1.0 / max(abs(speed), vec3(1.0e-20));
    vec3 next = t + (vec3(voxel + (way + 1) / 2) - at) * vec3(way) * pace;
    ivec3 end = mix(ivec3(-1), size, greaterThan(way, ivec3(0)));
    bool inside = true;
    while (inside && t < reach) {
      if (voxel_is_solid(volume, voxel)) return March(true, v, voxel);
      bvec3 least = bvec3(next.x <= next.y && next.x <= next.z, next.y < next.x && next.y <= next.z,
                          next.z < next.x && next.z < next.y);
      ivec3 step = ivec3(least);
      t = min(next.x, min(next.y, next.z));
      next += vec3(least) * pace;
      voxel += step * way;
      inside = all(notEqual(voxel, end));
    }
  }
  return m;
}
#endif
