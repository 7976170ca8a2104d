// One sample of every pixel: what the lamps and the world give, into the film's passes.
#define G_BUFFER_READ 1
#include "gpu_scene/view_shared.h"
#include "rasterize/g_buffer.glsl"
#include "base/albedo.glsl"
#include "realtime/brdf.glsl"
#include "radiance_cache/ambient.glsl"
#include "specular_rays/path_shared.h"
#include "film/film.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 7) uniform usampler2D visibility;
#if SCALED
layout(std430, binding = 0) readonly buffer Records { DrawRecord records[]; };
#endif
#if LAMPS
layout(binding = 0) uniform sampler2D diffuse_light;
#if GLOSSY
layout(binding = 1) uniform sampler2D glossy_light;
#endif
#endif
#if EMISSION
layout(binding = 2) uniform sampler2D emission;
#endif
#if BACKGROUND
layout(binding = 3) uniform sampler2D environment;
#endif
#if OCCLUSION
layout(binding = 4) uniform sampler2D occlusion;  // bent normal, visibility
layout(location = 2) uniform float strength;
#if PASS_OCCLUSION
layout(binding = 17) uniform sampler2D pass_occlusion;  // of the AO pass, which reaches farther
#endif
#if DEEP_SHADOWS
layout(binding = 5) uniform sampler2D deep;  // w: visibility
layout(location = 3) uniform float deep_strength;
#endif
#endif
#if SPECULAR_RAYS
// What rays bring, scattered once (a: FOLLOWS and LEFT_BY_REFRACTION bits) and more often.
layout(binding = 6) uniform sampler2D traced_direct;
layout(binding = 13) uniform sampler2D traced_indirect;
#endif

#if AMBIENT
#if OCCLUSION
// Share of reflected light that comes past what occludes the surface (Lagarde and de Rousiers 2014).
float specular_visibility(float visible, float roughness, float nv) {
  return clamp(pow(nv + visible, exp2(-16.0 * roughness - 1.0)) - 1.0 + visible, 0.0, 1.0);
}
#else
float specular_visibility(float visible, float roughness, float nv) { return 1.0; }
#endif
#endif

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, view.size.xy))) return;
  bool covered = texelFetch(visibility, pixel, 0).x != 0u;
  GBufferPixel g = read_g_buffer(pixel);
  vec3 v = -view_direction(vec2(pixel) + 0.5);

  vec3 diffuse = vec3(0.0), glossy = vec3(0.0), emitted = vec3(0.0), background = vec3(0.0);
  vec3 transmitted = vec3(0.0), diffuse_indirect = vec3(0.0), glossy_indirect = vec3(0.0),
       transmitted_indirect = vec3(0.0);
  uint followed = 0u;  // lobes that a ray stands for
#if SPECULAR_RAYS
  vec4 traced = texelFetch(traced_direct, pixel, 0);
  followed = uint(traced.a);
#endif
#if LAMPS
  diffuse = texelFetch(diffuse_light, pixel, 0).rgb;
#if GLOSSY
  glossy = texelFetch(glossy_light, pixel, 0).rgb;
#endif
#endif
  float visible = 1.0;
#if OCCLUSION
  vec4 occluded = texelFetch(occlusion, pixel, 0);
#endif
#if SCALED
  uint instance = covered ? records[texelFetch(visibility, pixel, 0).x - 1u].instance : 0u;
#endif
#if AMBIENT
  float nv = max(dot(g.normal, v), 0.0);
  vec3 open = g.normal;
#if OCCLUSION
  visible = mix(1.0, occluded.w, strength);
#if DEEP_SHADOWS
  visible *= mix(1.0, texelFetch(deep, pixel, 0).w, deep_strength);
#endif
  open = mix(open, occluded.xyz, strength);
  float size = length(open);
  open = size > 1.0e-3 ? open / size : g.normal;
#endif
  Around here = look_around(g.position, g.geometric_normal);
  Ambient around = ambient_diffuse(here, open);
#if SCALED
  around.bounced = scaled_light(around.bounced, g.position, instance);
#endif
  vec3 sent = visible * g.diffuse * diffuse_albedo(g.diffuse_roughness, nv);
#if LAYERS
  sent += visible * g.sheen * sheen_albedo(g.sheen_roughness, nv);
#endif
  diffuse += sent * around.world;
  diffuse_indirect += sent * around.bounced;
  // Reflected and refracted light from blurred radiance, where no ray is traced.
#if GLOSSY
  if ((followed & FOLLOWS_SPECULAR) == 0u) {
    Ambient mirrored = ambient_radiance(here, reflect(-v, g.normal), g.roughness);
#if SCALED
    mirrored.bounced = scaled_light(mirrored.bounced, g.position, instance);
#endif
    vec3 reflected = environment_reflectance(g.specular, g.grazing, g.roughness, nv) *
                     specular_visibility(visible, g.roughness, nv);
    glossy += reflected * mirrored.world;
    glossy_indirect += reflected * mirrored.bounced;
  }
#if LAYERS
  if ((followed & FOLLOWS_COAT) == 0u) {
    float coat_nv = max(dot(g.coat_normal, v), 0.0), coat_roughness = abs(g.coat_roughness);
    Ambient mirrored = ambient_radiance(here, reflect(-v, g.coat_normal), coat_roughness);
    vec3 reflected = environment_reflectance(vec3(g.coat * reflectance_from_ior(COAT_IOR)), vec3(g.coat),
                                             coat_roughness, coat_nv) *
                     specular_visibility(visible, coat_roughness, nv);
    glossy += reflected * mirrored.world;
    glossy_indirect += reflected * mirrored.bounced;
  }
#endif
#endif
#if TRANSMISSION
  if ((followed & FOLLOWS_TRANSMISSION) == 0u) {
    Ambient behind = ambient_radiance(look_around(g.position, -g.geometric_normal), -v,
                                      g.transmission_roughness);
    transmitted = g.transmission * behind.world;
    transmitted_indirect = g.transmission * behind.bounced;
  }
#endif
#endif
#if SPECULAR_RAYS
  vec3 indirect = texelFetch(traced_indirect, pixel, 0).rgb;
  if ((followed & LEFT_BY_REFRACTION) != 0u) {
    transmitted += traced.rgb;
    transmitted_indirect += indirect;
  } else if (followed != 0u) {
    glossy += traced.rgb;
    glossy_indirect += indirect;
  }
#endif
#if EMISSION
  emitted = texelFetch(emission, pixel, 0).rgb;
#endif
#if BACKGROUND
  background = covered ? vec3(0.0) : texelFetch(environment, pixel, 0).rgb;
#endif
  if (!covered) {
    diffuse = vec3(0.0);
    glossy = vec3(0.0);
    glossy_indirect = vec3(0.0);
    transmitted = vec3(0.0);
    diffuse_indirect = vec3(0.0);
    transmitted_indirect = vec3(0.0);
    emitted = vec3(0.0);
    g.diffuse = vec3(0.0);
    g.sheen = vec3(0.0);
    g.specular = vec3(0.0);
    g.transmission = vec3(0.0);
    g.normal = vec3(0.0);
  }
  vec3 combined = diffuse + diffuse_indirect + glossy + glossy_indirect + transmitted +
                  transmitted_indirect + emitted;
#if TRANSPARENT_FILM
  float coverage = covered ? 1.0 : 0.0;
#else
  combined += background;
  const float coverage = 1.0;
#endif
  film_add(FILM_COMBINED, pixel, vec4(combined, coverage));
#ifdef FILM_NORMAL
  film_add(FILM_NORMAL, pixel, vec4(g.normal, 0.0));
#endif
#ifdef FILM_DIFFCOL
  film_add(FILM_DIFFCOL, pixel, vec4(g.diffuse + g.sheen, 0.0));
#endif
#ifdef FILM_DIFFDIR
  film_add(FILM_DIFFDIR, pixel, vec4(diffuse, 0.0));
#endif
#ifdef FILM_DIFFIND
  film_add(FILM_DIFFIND, pixel, vec4(diffuse_indirect, 0.0));
#endif
#ifdef FILM_GLOSSCOL
  film_add(FILM_GLOSSCOL, pixel,
           vec4(vec3(any(greaterThan(g.specular, vec3(0.0))) ? 1.0 : 0.0), 0.0));
#endif
#ifdef FILM_GLOSSDIR
  film_add(FILM_GLOSSDIR, pixel, vec4(glossy, 0.0));
#endif
#ifdef FILM_GLOSSIND
  film_add(FILM_GLOSSIND, pixel, vec4(glossy_indirect, 0.0));
#endif
#ifdef FILM_TRANSCOL
  film_add(FILM_TRANSCOL, pixel, vec4(g.transmission, 0.0));
#endif
#ifdef FILM_TRANSDIR
  film_add(FILM_TRANSDIR, pixel, vec4(transmitted, 0.0));
#endif
#ifdef FILM_TRANSIND
  film_add(FILM_TRANSIND, pixel, vec4(transmitted_indirect, 0.0));
#endif
#ifdef FILM_EMIT
  film_add(FILM_EMIT, pixel, vec4(emitted, 0.0));
#endif
#if OCCLUSION && defined(FILM_AO)
#if PASS_OCCLUSION
  float around_all = texelFetch(pass_occlusion, pixel, 0).w;
#else
  float around_all = occluded.w;
#endif
  film_add(FILM_AO, pixel, vec4(vec3(covered ? around_all : 0.0), 0.0));
#endif
#ifdef FILM_ENV
  film_add(FILM_ENV, pixel, vec4(background, 0.0));
#endif
}
