// Points of lights and their densities: what a record of light says about one light alone.
//
// All densities are per solid angle. Lamps are Cycles' (measured in 3.4): points are disks that face
// the receiver, spots disks square to their axis, suns disks at distance 1 that send as much from
// each part of the disk's area.
#include "base/disk.glsl"
#include "base/falloff.glsl"
#include "path_tracer/lights_shared.h"
#include "path_tracer/spherical_rectangle.glsl"

layout(binding = 0) uniform usamplerBuffer light_records;  // as LightRecord

const float FAR = 3.0e38;  // where there is no end
const float DISK_AREA = 3.14159265359;

LightRecord fetch_record(uint light) {
  int i = int(light) * RECORD_TEXELS;
  return LightRecord(uintBitsToFloat(texelFetch(light_records, i)),
                     uintBitsToFloat(texelFetch(light_records, i + 1)),
                     uintBitsToFloat(texelFetch(light_records, i + 2)),
                     uintBitsToFloat(texelFetch(light_records, i + 3)),
                     uintBitsToFloat(texelFetch(light_records, i + 4)),
                     uintBitsToFloat(texelFetch(light_records, i + 5)));
}

uint record_flags(LightRecord l) { return floatBitsToUint(l.place.w); }
uint record_kind(LightRecord l) { return record_flags(l) & KIND_MASK; }
bool is_round(uint kind) { return kind == KIND_POINT || kind == KIND_SPOT; }

float disk_area(LightRecord l) { return DISK_AREA * l.axis.w * l.axis.w; }

// What leaves a lamp in direction -`direction` and how dense directions are: radiance and density
// per solid angle at `distance`, where `cosine` is that of the lamp's surface.
struct Emitted {
  vec3 radiance;
  float pdf;
};

Emitted emitted_by_disk(LightRecord l, uint kind, float cosine, float distance2) {
  float area = disk_area(l);
  float falloff = kind == KIND_SPOT ? spot_falloff(vec2(l.front.w, l.back.w), cosine) / cosine : 1.0;
  return Emitted(l.front.xyz * (falloff / area), distance2 / (cosine * area));
}

Emitted emitted_by_area(LightRecord l, float cosine, float distance2) {
  return Emitted(l.front.xyz * (area_falloff(vec2(l.front.w, l.back.w), cosine) / cosine),
                 distance2 / (cosine * l.axis.w));
}

Emitted emitted_by_sun(LightRecord l, float cosine) {
  float pdf = 1.0 / (disk_area(l) * cosine * cosine * cosine);
  return Emitted(l.front.xyz * pdf, pdf);
}

// Less of the view, sr, and rounding would show; and then points that are even on a lamp do as well.
const float LEAST_SOLID_ANGLE = 0.03;

// A rectangle that is near enough to be sampled evenly by solid angle; that of others is 0.
SphericalRectangle near_rectangle(LightRecord l, vec3 from) {
  SphericalRectangle r = spherical_rectangle(l.place.xyz, l.edge_x.xyz, l.edge_y.xyz, from);
  bool square = (record_flags(l) & RECORD_SQUARE) != 0u;
  if (!square || r.solid_angle < LEAST_SOLID_ANGLE) r.solid_angle = 0.0;
  return r;
}

// A shadow ray ends before the surface that it was sent to, by more than rounding.
float before_surface(float distance) { return distance * (1.0 - 1.0 / 4096.0); }

void set_lamp(uint flags, Emitted e, inout LightSample s) {
  s.value = e.radiance;
  s.pdf = e.pdf;
  // Through walls no scattered ray could have met the lamp: all its light is the samples'.
  if ((flags & RECORD_SHADOWLESS) != 0u) {
    s.t_max = 0.0;
    s.singular = true;
    if (e.pdf > 0.0) {
      s.value /= e.pdf;
      s.pdf = 1.0;
    }
  }
}

// The light that comes from a point of the light that `random` stands for; s.pdf does not know yet of
// the choice among lights.
void sample_record(LightRecord l, vec3 from, vec2 random, inout LightSample s) {
  uint flags = record_flags(l), kind = flags & KIND_MASK;
  s.source = LIGHT_KNOWN;
  s.singular = (flags & RECORD_SINGULAR) != 0u;
#if LIGHT_SUNS
  if (kind == KIND_SUN) {
    vec3 x, y;
    make_frame(l.axis.xyz, x, y);
    vec2 disk = l.axis.w * concentric_disk(random);
    s.direction = normalize(-l.axis.xyz + disk.x * x + disk.y * y);
    s.t_max = FAR;
    Emitted e = s.singular ? Emitted(l.front.xyz, 1.0) : emitted_by_sun(l, -dot(s.direction, l.axis.xyz));
    set_lamp(flags, e, s);
    return;
  }
#endif
  vec3 point = l.place.xyz, normal = l.axis.xyz;
#if LIGHT_POINTS || LIGHT_SPOTS
  if (is_round(kind)) {
    vec3 apart = from - point;
    float length2 = dot(apart, apart);
    if (kind == KIND_POINT) normal = length2 > 0.0 ? apart * inversesqrt(length2) : vec3(0.0, 0.0, 1.0);
    vec3 x, y;
    make_frame(normal, x, y);
    vec2 disk = l.axis.w * concentric_disk(random);
    point += disk.x * x + disk.y * y;
  }
#endif
#if LIGHT_AREAS
  SphericalRectangle rectangle = near_rectangle(l, from);
  if (rectangle.solid_angle > 0.0) {
    point = from + sample_spherical_rectangle(rectangle, random);
  } else if (kind == KIND_RECTANGLE || kind == KIND_ELLIPSE) {
    vec2 place = kind == KIND_ELLIPSE ? 0.5 * concentric_disk(random) : random - 0.5;
    point += place.x * l.edge_x.xyz + place.y * l.edge_y.xyz;
  }
#endif
#if LIGHT_TRIANGLES
  if (kind == KIND_TRIANGLE) {
    // Uniform over the triangle (Osada et al. 2002).
    float root = sqrt(random.x);
    s.u = root * (1.0 - random.y);
    s.v = root * random.y;
    point += s.u * l.edge_x.xyz + s.v * l.edge_y.xyz;
  }
#endif
  vec3 way = point - from;
  float distance2 = dot(way, way);
  // False for what is not a number, too.
  if (!(distance2 > 1.0e-37 && distance2 < 1.0e37)) return;
  float distance = sqrt(distance2);
  s.direction = way / distance;
  s.t_max = before_surface(distance);
  float cosine = -dot(s.direction, normal);
#if LIGHT_TRIANGLES
  if (kind == KIND_TRIANGLE) {
    s.value = cosine > 0.0 ? l.front.xyz : l.back.xyz;
    cosine = abs(cosine);
    s.seen_by = flags >> RECORD_SEEN_BY_SHIFT;
    if ((flags & RECORD_VARIES) != 0u) {
      s.source = floatBitsToUint(l.edge_y.w);
      s.value = vec3(1.0);
    }
    if (cosine > 0.0) s.pdf = distance2 / (cosine * l.axis.w);
    return;
  }
#endif
  vec2 cone = vec2(l.front.w, l.back.w);
  if (s.singular) {
    float falloff = kind == KIND_POINT ? 1.0
                    : kind == KIND_SPOT ? spot_falloff(cone, cosine) : area_falloff(cone, cosine);
    set_lamp(flags, Emitted(l.front.xyz * (falloff / distance2), falloff > 0.0 ? 1.0 : 0.0), s);
    return;
  }
  if (cosine <= 0.0) return;
  Emitted e = is_round(kind) ? emitted_by_disk(l, kind, cosine, distance2)
                             : emitted_by_area(l, cosine, distance2);
#if LIGHT_AREAS
  if (rectangle.solid_angle > 0.0) e.pdf = 1.0 / rectangle.solid_angle;
#endif
  set_lamp(flags, e, s);
}
