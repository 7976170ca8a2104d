// Choices of the radiance cache and their names in settings and options.
#pragma once

#include <array>
#include <string_view>

namespace panoptes::radiance_cache {

// Bands of spherical harmonics of luminance and of both chrominances, or of red, green and blue
// (thesis, section 5.4 and Figure 5.11).
enum class Encoding { kY3Co1Cg1, kY3Co2Cg2, kY3Co3Cg3, kRgb3, kY2Co2Cg2, kRgb2 };
constexpr std::array<std::string_view, 6> kEncodingNames{"y3co1cg1", "y3co2cg2", "y3co3cg3",
                                                         "rgb3",     "y2co2cg2", "rgb2"};

// Where the light of the first bounce comes from.
enum class FirstBounce {
  kSurfaces,  // lit points of the surfaces that marched rays meet
  kRsm,       // reflective shadow maps, as the thesis has it
};
constexpr std::array<std::string_view, 2> kFirstBounceNames{"surfaces", "rsm"};

// Which cells hold light (section 5.5).
enum class Occupancy {
  kAuto,      // what one picture needs: for one bounce kDepth, for more kTiers; kGeometry where frames follow
              // each other or rays look up light anywhere
  kGeometry,  // those that hold geometry
  kDepth,     // those that the camera sees
  kTiers,     // those, and in fewer directions the others that hold geometry, for the light that they send there
  kAll,       // every one: what occupancy is measured against
};
constexpr std::array<std::string_view, 5> kOccupancyNames{"auto", "geometry", "depth", "tiers", "all"};

// What is shown in place of the scene.
enum class Picture {
  kNone,
  kGeometry,   // voxels of the geometry volume, by their albedo
  kOccupancy,  // cells: green: hold light, red: only after dilation
  kLobes,      // a ball in each cell that is seen, with the light that arrives there from all around
  kLight,      // light of the cache alone, on white surfaces
  kClipped,    // what was cut off where harmonics ring below 0, relative to the light
};
constexpr std::array<std::string_view, 6> kPictureNames{"none",  "geometry", "occupancy",
                                                        "lobes", "light",    "clipped"};

}  // namespace panoptes::radiance_cache
