// Lights as paths sample them: records, the tree by which one of many is chosen, and constants.
// Records and nodes lie in buffer textures of 32-bit words, four a texel.
#pragma once

#include "base/cpp_glsl.h"

SHARED_BEGIN

// LightRecord.kind, lowest byte.
const uint KIND_SUN = 0u;
const uint KIND_POINT = 1u;
const uint KIND_SPOT = 2u;
const uint KIND_RECTANGLE = 3u;
const uint KIND_ELLIPSE = 4u;
const uint KIND_TRIANGLE = 5u;
const uint KIND_MASK = 255u;
// Above it.
const uint RECORD_SINGULAR = 256u;    // without an area: only sampling finds it
const uint RECORD_SHADOWLESS = 512u;
const uint RECORD_VARIES = 1024u;     // radiance is another at each place: to be asked of the material
const uint RECORD_SQUARE = 2048u;     // a rectangle whose sides are square to each other
const uint RECORD_SEEN_BY_SHIFT = 16u;  // triangles: SEEN_BY_... bits of their instance

struct LightRecord {
  vec4 place;   // xyz: centre of a lamp, first corner of a triangle; relative to the list of
                // triangles' origin, metres; w: kind (bits)
  vec4 edge_x;  // xyz: areas: whole side or diameter; triangles: second corner - first; w: trail (bits)
  vec4 edge_y;  // likewise, of the third corner; w: a triangle's primitive, a lamp's number (bits)
  vec4 axis;    // xyz: unit, where it shines; triangles: normal of the front;
                // w: points, spots: radius in metres; suns: tan(angle / 2); areas, triangles: m2
  vec4 front;   // xyz: radiance of areas and triangles' fronts; radiant intensity of points, spots
                // and areas without an area; irradiance of suns; w: cone.x of base/falloff.glsl
  vec4 back;    // xyz: radiance of triangles' backs; w: cone.y
};
SHARED_ASSERT_SIZE(LightRecord, 96)
const int RECORD_TEXELS = 6;

// Trees lie in depth-first order: the first child of a node follows it.
const uint NODE_LEAF = 0x80000000u;
const uint NODE_TWO_SIDED = 0x40000000u;  // what holds about the axis holds about its opposite
const uint NODE_INFINITE = 0x20000000u;   // of suns: bounds mean nothing
const uint NODE_INDEX = 0x1fffffffu;

struct LightNode {
  float low_x, low_y, low_z;     // bounds, as LightRecord.place
  float intensity;  // most that goes in any direction, summed: W/sr; of suns irradiance, W/m2
  float high_x, high_y, high_z;
  uint child;       // leaves: the record; others: the second child; and NODE_... bits
  uint axis;        // packed unit (base/packing.glsl): where it shines
  float cosine_o;   // of the cone about the axis that holds all normals
  float cosine_e;   // how far from its normal something still shines
  uint skip;        // the node after all below this one
};
SHARED_ASSERT_SIZE(LightNode, 48)
const int NODE_TEXELS = 3;

// Levels of a tree below its root: a trail is a bit a level, the lowest for the root, set where the
// way goes on to the second child.
const int MOST_LEVELS = 32;

const uint NO_LIGHT = 0xffffffffu;

// LightSample.source; others are primitives.
const uint LIGHT_KNOWN = 0xffffffffu;  // the value is complete
const uint LIGHT_WORLD = 0xfffffffeu;  // to be multiplied by the world's radiance from the direction

struct LightConstants {
  uint first_glowing;     // primitive that the map to records begins with
  uint glowing_count;     // length of that map
  uint first_seen;        // node where the tree of lamps that have an extent begins
  uint end_seen;
  uint seen_suns;         // records from 0 on that are suns with an extent
  uint world_width, world_height;  // texels of the world's map
  float world_irradiance;  // about what the world gives, W/m2
};
SHARED_ASSERT_SIZE(LightConstants, 32)

SHARED_END
