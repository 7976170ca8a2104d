// Choices of the multilayer structure of fragments (thesis, chapter 6), and how a variant lies in memory.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace panoptes::fragment_tracer {

// How a pixel's fragments are stored (section 6.3.5).
enum class Storage {
  kArray,               // SB: one behind the other (Vasilakis and Fudos 2012)
  kList,                // LL: linked from the nearest on (Yang et al. 2010)
  kDoubleList,          // DLL: linked both ways
  kBucketList,          // LLB: a list for each interval of depth (Vasilakis and Fudos 2013)
  kDoubleBucketList,    // DLLB: the thesis' own
};
constexpr std::array<std::string_view, 5> kStorageNames{"SB", "LL", "DLL", "LLB", "DLLB"};

constexpr bool has_buckets(Storage storage) { return storage >= Storage::kBucketList; }
// Links of a node: to the next, and to the one before.
constexpr int links(Storage storage) {
  switch (storage) {
    case Storage::kArray: return 0;
    case Storage::kList:
    case Storage::kBucketList: return 1;
    default: return 2;
  }
}

// Which pixels of its way a ray looks into (section 6.2.3).
enum class Walk {
  kEveryPixel,
  kSteps,      // a fixed number over each view, jittered by the ray's seed
  kHierarchy,  // Hi-Z: cells of pixels are passed over where their bounds of depth allow it
};
constexpr std::array<std::string_view, 3> kWalkNames{"every_pixel", "steps", "hierarchy"};

// Which layers there are.
enum class Views {
  kCubeAndCamera,
  kCube,
  kCamera,  // what the camera does not see, no ray meets
};
constexpr std::array<std::string_view, 3> kViewsNames{"cube_and_camera", "cube", "camera"};

// Where the depths of a pixel's buckets come from.
enum class Bounds {
  kExact,  // its fragments
  kBoxes,  // boxes about triangles that follow each other in the list (docs/fragments.md tells when that is slower)
};
constexpr std::array<std::string_view, 2> kBoundsNames{"exact", "boxes"};

struct Settings {
  Views views = Views::kCubeAndCamera;
  int side = 256;          // pixels of a face of the cube, 1 .. 4096
  // Pixels across the camera's view, up to 16384; 0: as many as the picture has, and no fewer than the cube has there.
  int camera_width = 0;
  Storage storage = Storage::kDoubleBucketList;
  int buckets = 8;         // of a pixel, over its depths, 1 .. 64
  Bounds bounds = Bounds::kExact;
  int layers = 0;          // fragments that a pixel keeps, from the nearest on (a k-buffer), to 256; 0: all. Not with buckets.
  bool decoupled = true;   // what only hits read lies apart from what every test reads
  bool skipping = true;    // passes over pixels and buckets whose depths the ray does not reach
  bool binary_search = true;  // with kArray
  Walk walk = Walk::kHierarchy;
  int steps = 32;          // with Walk::kSteps, 1 .. 4096
  // A surface goes on behind its fragment for this share of its depth, 0 .. 1; by its plane it is looked for over as much
  // or, where pixels are wide, over more.
  float thickness = 0.02f;
  // Fragments are hit where their triangle's plane is, in place of anywhere in their pixel.
  bool by_plane = true;

  bool operator==(const Settings&) const = default;
  // Throws Error with a sentence when a value is out of range.
  void check() const;
};

// Bytes of a pixel and of a fragment (Table 6.2). The table's entry for LLB adds the data of a fragment that the others
// leave out; here all leave them out, and they are kDataBytes each wherever they lie. An array needs a word for the way
// to the data only where these lie apart.
inline constexpr int kDataBytes = 12;  // primitive, barycentric coordinates
constexpr int pixel_bytes(const Settings& s) {
  if (has_buckets(s.storage)) return 8 + 4 * s.buckets * links(s.storage);
  return s.storage == Storage::kList ? 4 : 8;
}
constexpr int fragment_bytes(const Settings& s) {
  return 4 + 4 * links(s.storage) + (s.storage == Storage::kArray && s.decoupled ? 4 : 0);
}

}  // namespace panoptes::fragment_tracer
