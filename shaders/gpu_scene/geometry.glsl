// The scene's geometry as buffer textures, and the pull of one hit's attributes out of it.
// Random reads through texelFetch are several times faster than through storage blocks on llvmpipe.
#include "base/packing.glsl"
#include "gpu_scene/view_shared.h"
#include "scene/visibility_shared.h"

layout(binding = 0) uniform samplerBuffer vertex_positions;    // object space, metres
layout(binding = 1) uniform usamplerBuffer triangle_vertices;  // three indices into the mesh's own
layout(binding = 2) uniform usamplerBuffer corner_normals;     // three packed units, object space
layout(binding = 3) uniform samplerBuffer corner_attributes;   // pairs of floats
layout(binding = 4) uniform samplerBuffer instances;  // 3 rows of object-to-world; bits {mesh
                                                      // record, visibility, seed, scales}
layout(binding = 5) uniform usamplerBuffer tables;    // mesh records, attribute names of materials

// Words of a mesh record in `tables`, then one word an attribute name: the first pair of floats and
// IS_COLOR, or NO_ATTRIBUTE.
const int MESH_VERTEX_BASE = 0;
const int MESH_TRIANGLE_BASE = 1;
const int MESH_GENERATED = 2;  // six floats: scale and offset from object space to 0..1
const int MESH_SEED = 8;
const int MESH_ATTRIBUTES = 9;
const uint NO_ATTRIBUTE = 0xffffffffu;
const uint IS_COLOR = 0x80000000u;  // two pairs a corner instead of one
const int UV_DEFAULT = 0;
const int COLOR_DEFAULT = 1;

uint table(int i) { return texelFetch(tables, i).x; }

struct Transform {
  mat3 linear;       // object to world
  vec3 translation;  // relative to the view's origin
};

Transform fetch_transform(uint instance, vec3 world_origin) {
  int i = int(instance) * 4;
  vec4 x = texelFetch(instances, i), y = texelFetch(instances, i + 1),
       z = texelFetch(instances, i + 2);
  Transform t;
  t.linear = transpose(mat3(x.xyz, y.xyz, z.xyz));
  t.translation = vec3(x.w, y.w, z.w) - world_origin;
  return t;
}

int fetch_mesh_record(uint instance) {
  return int(floatBitsToUint(texelFetch(instances, int(instance) * 4 + 3).x));
}

// A number for drawing random ones: the same whatever the order of the scene's instances.
uint fetch_seed(uint instance) {
  vec4 bits = texelFetch(instances, int(instance) * 4 + 3);
  return floatBitsToUint(bits.z) ^ table(int(floatBitsToUint(bits.x)) + MESH_SEED);
}

// SEEN_BY_CAMERA and its like.
uint fetch_visibility(uint instance) {
  return floatBitsToUint(texelFetch(instances, int(instance) * 4 + 3).y);
}

// What the indirect light of an instance is multiplied by: luminance and chrominance.
vec2 fetch_indirect_scale(uint instance) {
  return unpackHalf2x16(floatBitsToUint(texelFetch(instances, int(instance) * 4 + 3).w));
}

// The transpose of the inverse times the determinant: normals go through it whatever the scale,
// and singular matrices do no harm.
mat3 cofactors(mat3 m) {
  return mat3(cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1]));
}

float determinant_sign(mat3 m) { return dot(m[0], cross(m[1], m[2])) < 0.0 ? -1.0 : 1.0; }

vec3 safe_normalize(vec3 v, vec3 otherwise) {
  float largest = max(max(abs(v.x), abs(v.y)), abs(v.z));
  if (!(largest > 0.0)) return otherwise;
  v /= largest;  // squares of tiny edges underflow
  return v * inversesqrt(dot(v, v));
}

// One point of a surface, as generated material code sees it. Vectors have world axes.
struct Hit {
  vec3 position;          // relative to the view's origin, metres
  vec3 normal;            // interpolated, unit, on the viewer's side
  vec3 geometric_normal;  // unit, on the viewer's side
  vec3 view;              // unit, towards the viewer
  bool backfacing;
  uint instance;
  int triangle;           // in the global triangle list
  int mesh;               // its record in `tables`
  vec3 barycentrics;
  vec3 normal_unflipped;  // interpolated, unit: as the mesh has it
  vec3 edge1, edge2;      // of the triangle, from its first vertex
  float area;             // twice the triangle's, square metres
  float handedness;       // -1 when the instance is mirrored
  float bulge;            // how far the smooth surface that the normals describe stands above
  float footprint;        // width of the pixel here, metres, square to the view direction
};

struct Ray {
  vec3 origin, direction;
};

Ray view_ray(vec2 pixel) {
  Ray ray;
  ray.origin = view.ray_origin.xyz + pixel.x * view.ray_origin_dx.xyz +
               pixel.y * view.ray_origin_dy.xyz;
  ray.direction = view.ray_direction.xyz + pixel.x * view.ray_direction_dx.xyz +
                  pixel.y * view.ray_direction_dy.xyz;
  return ray;
}

// Where `ray` meets the plane of triangle `triangle` (counted in its mesh) of `instance`. The
// rasteriser has found the triangle; rounding may put the meeting a little outside, so it is
// clamped to the triangle.
Hit fetch_hit(Ray ray, uint instance, uint triangle) {
  Hit hit;
  hit.instance = instance;
  hit.mesh = fetch_mesh_record(instance);
  hit.triangle = int(table(hit.mesh + MESH_TRIANGLE_BASE) + triangle);
  Transform transform = fetch_transform(instance, view.world_origin.xyz);

  uvec3 v = texelFetch(triangle_vertices, hit.triangle).xyz +
            table(hit.mesh + MESH_VERTEX_BASE);
  vec3 p0 = texelFetch(vertex_positions, int(v.x)).xyz;
  // Edges are transformed as vectors: the difference of transformed vertices loses their low bits.
  vec3 e1 = transform.linear * (texelFetch(vertex_positions, int(v.y)).xyz - p0);
  vec3 e2 = transform.linear * (texelFetch(vertex_positions, int(v.z)).xyz - p0);
  vec3 origin = transform.linear * p0 + transform.translation;

  vec3 across = cross(ray.direction, e2);
  float determinant = dot(e1, across);
  float inverse = determinant != 0.0 ? 1.0 / determinant : 0.0;
  vec3 offset = ray.origin - origin;
  float b1 = clamp(dot(offset, across) * inverse, 0.0, 1.0);
  float b2 = clamp(dot(ray.direction, cross(offset, e1)) * inverse, 0.0, 1.0 - b1);
  hit.barycentrics = vec3(1.0 - b1 - b2, b1, b2);
  hit.position = origin + b1 * e1 + b2 * e2;

  hit.view = normalize(-ray.direction);
  hit.edge1 = e1;
  hit.edge2 = e2;
  hit.handedness = determinant_sign(transform.linear);
  vec3 area = cross(e1, e2);
  hit.area = length(area);
  vec3 ng = safe_normalize(area, hit.view) * hit.handedness;
  hit.backfacing = dot(ng, ray.direction) > 0.0;
  hit.geometric_normal = hit.backfacing ? -ng : ng;

  uvec3 words = texelFetch(corner_normals, hit.triangle).xyz;
  mat3 to_normal = cofactors(transform.linear) * hit.handedness;
  vec3 n0 = safe_normalize(to_normal * unpack_unit(words.x), ng);
  vec3 n1 = safe_normalize(to_normal * unpack_unit(words.y), ng);
  vec3 n2 = safe_normalize(to_normal * unpack_unit(words.z), ng);
  hit.normal_unflipped = safe_normalize(hit.barycentrics.x * n0 + b1 * n1 + b2 * n2, ng);
  hit.normal = hit.backfacing ? -hit.normal_unflipped : hit.normal_unflipped;

  // The tangent planes at the corners, blended (Hanika 2021): shadows are looked up from there, or
  // the facets of a smooth convex mesh would shade themselves near the terminator.
  vec3 p = b1 * e1 + b2 * e2;
  float facing = hit.backfacing ? -1.0 : 1.0;
  hit.bulge = hit.barycentrics.x * max(0.0, -facing * dot(p, n0)) +
              b1 * max(0.0, -facing * dot(p - e1, n1)) + b2 * max(0.0, -facing * dot(p - e2, n2));

  float distance_along = view.filtering.z > 0.5 ? length(hit.position - ray.origin) : 1.0;
  hit.footprint = view.filtering.y * distance_along;
  return hit;
}

// --- attributes, by the name index that the mesh record is ordered by ------------------------------

vec2 interpolate_pairs(Hit hit, uint word, int pair) {
  int stride = (word & IS_COLOR) != 0u ? 2 : 1;
  int i = int(word & ~IS_COLOR) + pair + (hit.triangle - int(table(hit.mesh + MESH_TRIANGLE_BASE))) * 3 * stride;
  return hit.barycentrics.x * texelFetch(corner_attributes, i).xy +
         hit.barycentrics.y * texelFetch(corner_attributes, i + stride).xy +
         hit.barycentrics.z * texelFetch(corner_attributes, i + 2 * stride).xy;
}

// Texture coordinates; (0, 0) where the mesh has none of that name, as in Cycles.
vec2 hit_uv(Hit hit, int name) {
  uint word = table(hit.mesh + MESH_ATTRIBUTES + name);
  return word == NO_ATTRIBUTE ? vec2(0.0) : interpolate_pairs(hit, word, 0);
}

// Scene-linear colour, or (u, v, 0, 1) of a UV map; black with alpha 0 where the mesh has none of that name, as in Cycles.
vec4 hit_color(Hit hit, int name) {
  uint word = table(hit.mesh + MESH_ATTRIBUTES + name);
  if (word == NO_ATTRIBUTE) return vec4(0.0);
  vec2 pair = interpolate_pairs(hit, word, 0);
  return (word & IS_COLOR) != 0u ? vec4(pair, interpolate_pairs(hit, word, 1)) : vec4(pair, 0.0, 1.0);
}

vec3 hit_world_position(Hit hit) { return hit.position + view.world_origin.xyz; }

vec3 hit_object_position(Hit hit) {
  uvec3 v = texelFetch(triangle_vertices, hit.triangle).xyz + table(hit.mesh + MESH_VERTEX_BASE);
  return hit.barycentrics.x * texelFetch(vertex_positions, int(v.x)).xyz +
         hit.barycentrics.y * texelFetch(vertex_positions, int(v.y)).xyz +
         hit.barycentrics.z * texelFetch(vertex_positions, int(v.z)).xyz;
}

// A point in object space, with the mesh's texture space mapped to 0..1.
vec3 hit_generated(Hit hit, vec3 position) {
  vec3 scale, offset;
  for (int i = 0; i < 3; ++i) {
    scale[i] = uintBitsToFloat(table(hit.mesh + MESH_GENERATED + i));
    offset[i] = uintBitsToFloat(table(hit.mesh + MESH_GENERATED + 3 + i));
  }
  return position * scale + offset;
}

vec3 hit_generated(Hit hit) { return hit_generated(hit, hit_object_position(hit)); }

// `undeformed` names where points were before modifiers and shape keys moved them; meshes that
// nothing moves are without.
vec3 hit_generated(Hit hit, int undeformed) {
  if (table(hit.mesh + MESH_ATTRIBUTES + undeformed) == NO_ATTRIBUTE) return hit_generated(hit);
  return hit_generated(hit, hit_color(hit, undeformed).xyz);
}
