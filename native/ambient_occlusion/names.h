// Choices of ambient occlusion and their names in settings and options.
#pragma once

#include <array>
#include <string_view>

namespace panoptes::ambient_occlusion {

enum class Estimator { kAlchemy, kSsao, kHbao };
constexpr std::array<std::string_view, 3> kEstimatorNames{"alchemy", "ssao", "hbao"};

// Whether the pair of views behind the camera is drawn; kAuto: where others cover too little.
enum class Phantoms { kAuto, kOff, kOn };
constexpr std::array<std::string_view, 3> kPhantomsNames{"auto", "off", "on"};

// Joint bilateral filter; kAuto: unless the picture has many samples.
enum class Filter { kAuto, kOff, kOn };
constexpr std::array<std::string_view, 3> kFilterNames{"auto", "off", "on"};

// What is shown in place of the scene.
enum class Picture {
  kNone,
  kWeights,       // red: the camera's, green and blue: of the first two others
  kSamples,       // of all views, relative to the most there may be: blue few, red all
  kContribution,  // what the picture would lack without a view; red, green, blue: the first three others
  kBentNormals,   // .5 + .5 * normal, world space
  kSingleView,    // visibility, by the camera alone and without the filter
  kMultiview,     // visibility, by all views
};
constexpr std::array<std::string_view, 7> kPictureNames{
    "none", "weights", "samples", "contribution", "bent_normals", "single_view", "multiview"};

}  // namespace panoptes::ambient_occlusion
