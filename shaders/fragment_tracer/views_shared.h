// The views whose fragments rays are traced through, and what the build counts.
#pragma once

#include "base/cpp_glsl.h"

SHARED_BEGIN

// Positions are relative to FragmentViews.centre, the eye of all views. Dot products with x and y over that with z are
// pixels; that with z is the depth along the view's axis, metres.
struct FragmentView {
  vec4 x;      // w: width of a pixel at a depth of one metre
  vec4 y;
  vec4 z;
  ivec4 size;  // x, y: pixels; z: number of its first pixel among those of all views; w: its levels above the pixels
};
SHARED_ASSERT_SIZE(FragmentView, 64)

const uint MOST_VIEWS = 7u;
const uint SIFTED_AT_ONCE = 16u;   // triangles that an invocation asks which views see
const uint TRIANGLES_OF_BOX = 64u; // with bounds of depth by boxes
const uint MOST_LEVELS = 16u;  // of a view's pyramid of depth bounds

struct FragmentViews {
  FragmentView views[MOST_VIEWS];
  vec4 centre;  // xyz: relative to the list's origin
  vec4 low;     // xyz: corner of the scene's box, relative to the list's origin
  vec4 high;    // xyz: the opposite corner
  ivec4 walk;   // x: with fixed steps their number across a view
  vec4 limits;  // x: thickness, as a share of the depth
  ivec4 level_first[MOST_VIEWS * MOST_LEVELS / 4u];  // of view * MOST_LEVELS + level, four to an entry: its first cell
};
SHARED_ASSERT_SIZE(FragmentViews, 976)

struct FragmentCounters {
  uint fragments;  // of all views, those that found no room among them
  uint placed;     // fragments that have a place in the sorted runs
  uint longest;    // fragments of the longest list
  uint used;       // lists that have fragments
};
SHARED_ASSERT_SIZE(FragmentCounters, 16)

// While it is built: where a fragment belongs.
struct FragmentEntry {
  float depth;
  uint list;       // pixel * buckets + bucket
  uint rank;       // in the order of arrival
  uint primitive;
};
SHARED_ASSERT_SIZE(FragmentEntry, 16)

// No node, no primitive.
const uint NO_FRAGMENT = 0xffffffffu;

SHARED_END
