// One level of the edge-avoiding filter (native/denoise/edge_avoiding.h): light is averaged over 5x5 pixels that lie
// `spacing` apart. With SMOOTHS_VARIANCE its variance is, over 7x7, and light stays: that of a single pixel is told by as
// few samples as its light, and misses what has not been met yet. Outliers keep theirs, and are spread.
layout(local_size_x = 16, local_size_y = 16) in;
layout(binding = 0) uniform sampler2D light;    // rgb; a: variance
layout(binding = 1) uniform sampler2D normals;  // unit; a: how long the average was, 0 without a surface
layout(binding = 2) uniform sampler2D albedos;
#if POSITIONS
layout(binding = 3) uniform sampler2D positions;
#endif
layout(binding = 0, rgba32f) writeonly uniform image2D filtered;
layout(location = 0) uniform int spacing;

// How different neighbours may be: the cosine between normals by its power, the sine between the surface and what
// connects them, and the distance between albedos. Loose, since bumps and edges would keep their noise otherwise, and
// light that differs tells by itself.
const float NORMAL_POWER = 8.0;
const float SLOPE = 1.0;
const float ALBEDO = 0.25;
// Of their common deviation: pixels that are equal but for their noise count by seven eighths.
const float DEVIATIONS = 1.75;
// B3 spline, by the distance from the centre.
const float SPLINE[3] = float[](0.375, 0.25, 0.0625);

struct Guide {
  vec4 normal;
  vec3 albedo, position;
};

Guide guide_at(ivec2 pixel) {
  Guide g;
  g.normal = texelFetch(normals, pixel, 0);
  g.albedo = texelFetch(albedos, pixel, 0).rgb;
#if POSITIONS
  g.position = texelFetch(positions, pixel, 0).xyz;
#endif
  return g;
}

// 0 .. 1: whether two pixels show the same surface.
float alike(Guide a, Guide b) {
  if (a.normal.w == 0.0 || b.normal.w == 0.0) return 0.0;
  float weight = pow(max(dot(a.normal.xyz, b.normal.xyz), 0.0), NORMAL_POWER);
  vec3 colour = a.albedo - b.albedo;
  float apart = dot(colour, colour) / (ALBEDO * ALBEDO);
#if POSITIONS
  // Relative to the distance: neither the scene's scale nor the slant of the surface counts.
  vec3 way = b.position - a.position;
  float off = max(abs(dot(a.normal.xyz, way)), abs(dot(b.normal.xyz, way)));
  apart += off * off / max(dot(way, way) * SLOPE * SLOPE, 1e-30);
#endif
  return weight * exp(-apart);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = textureSize(light, 0);
  if (any(greaterThanEqual(pixel, size))) return;
  vec4 centre = texelFetch(light, pixel, 0);
  Guide here = guide_at(pixel);
  if (here.normal.w == 0.0) {
    imageStore(filtered, pixel, centre);
    return;
  }
#if SMOOTHS_VARIANCE
  float sum = centre.a, weights = 1.0;
  for (int y = -3; y <= 3; ++y)
    for (int x = -3; x <= 3; ++x) {
      ivec2 other = pixel + ivec2(x, y);
      bool outside = any(lessThan(other, ivec2(0))) || any(greaterThanEqual(other, size));
      if (outside || (x == 0 && y == 0)) continue;
      float weight = alike(here, guide_at(other));
      sum += weight * texelFetch(light, other, 0).a;
      weights += weight;
    }
  imageStore(filtered, pixel, vec4(centre.rgb, max(centre.a, sum / weights)));
#else
  // What differs keeps its light, in place of passing it on by halves: nothing is lost, outliers neither.
  float guided = SPLINE[0] * SPLINE[0], kept = guided, squares = 0.0, variances = 0.0;
  vec3 change = vec3(0.0);
  for (int y = -2; y <= 2; ++y)
    for (int x = -2; x <= 2; ++x) {
      ivec2 other = pixel + spacing * ivec2(x, y);
      bool outside = any(lessThan(other, ivec2(0))) || any(greaterThanEqual(other, size));
      if (outside || (x == 0 && y == 0)) continue;
      vec4 found = texelFetch(light, other, 0);
      vec3 apart = found.rgb - centre.rgb;
      // Without noise, only what is the same counts.
      float variance = max(found.a + centre.a, 1e-30);
      float guide = SPLINE[abs(x)] * SPLINE[abs(y)] * alike(here, guide_at(other));
      float weight = guide * exp(-dot(apart, apart) / (6.0 * DEVIATIONS * DEVIATIONS * variance));
      change += weight * apart;
      guided += guide;
      kept += guide - weight;
      squares += weight * weight;
      variances += weight * found.a;
    }
  float least = (squares + kept * kept) / (guided * guided);
  float mean_variance = (variances + kept * centre.a) / guided;
  // After the first level neighbours have noise in common, and it falls by the square root of what it would.
  imageStore(filtered, pixel, vec4(centre.rgb + change / guided, mean_variance * (spacing == 1 ? least : sqrt(least))));
#endif
}
