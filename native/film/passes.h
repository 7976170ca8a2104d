// The passes of a picture, under Blender's names.
#pragma once

#include <array>
#include <bitset>
#include <string_view>

namespace panoptes::film {

enum class Pass {
  kCombined, kDepth, kPosition, kNormal,
  kDiffCol, kDiffDir, kDiffInd, kGlossCol, kGlossDir, kGlossInd, kTransCol, kTransDir, kTransInd,
  kEmit, kEnv, kAo, kSampleCount, kNoisyImage, kCount
};
constexpr int kPassCount = int(Pass::kCount);

enum class PassKind {
  kSum,      // of all samples, averaged
  kFirst,    // of the first sample alone: neither filtered nor averaged
  kSamples,  // tells of the samples: the film makes it itself
  kNoisy,    // Combined before it is denoised
};

struct PassInfo {
  std::string_view name;      // Blender's
  int channels;               // 4: RGBA, 3: RGB or XYZ, 1: Z
  std::string_view define;    // that gives its layer to the shaders; none where the film makes it
  Pass divisor;               // colour that is divided out of it; itself for none
  bool light;                 // scaled by the film's exposure
  PassKind kind = PassKind::kSum;
};

constexpr std::array<PassInfo, kPassCount> kPasses{{
    {"Combined", 4, "FILM_COMBINED", Pass::kCombined, true},
    {"Depth", 1, "FILM_DEPTH", Pass::kDepth, false, PassKind::kFirst},
    {"Position", 3, "FILM_POSITION", Pass::kPosition, false, PassKind::kFirst},
    {"Normal", 3, "FILM_NORMAL", Pass::kNormal, false},
    {"DiffCol", 3, "FILM_DIFFCOL", Pass::kDiffCol, false},
    {"DiffDir", 3, "FILM_DIFFDIR", Pass::kDiffCol, true},
    {"DiffInd", 3, "FILM_DIFFIND", Pass::kDiffCol, true},
    {"GlossCol", 3, "FILM_GLOSSCOL", Pass::kGlossCol, false},
    {"GlossDir", 3, "FILM_GLOSSDIR", Pass::kGlossCol, true},
    {"GlossInd", 3, "FILM_GLOSSIND", Pass::kGlossCol, true},
    {"TransCol", 3, "FILM_TRANSCOL", Pass::kTransCol, false},
    {"TransDir", 3, "FILM_TRANSDIR", Pass::kTransCol, true},
    {"TransInd", 3, "FILM_TRANSIND", Pass::kTransCol, true},
    {"Emit", 3, "FILM_EMIT", Pass::kEmit, true},
    {"Env", 3, "FILM_ENV", Pass::kEnv, true},
    {"AO", 3, "FILM_AO", Pass::kAo, false},
    {"Debug Sample Count", 1, "", Pass::kSampleCount, false, PassKind::kSamples},
    {"Noisy Image", 4, "", Pass::kNoisyImage, true, PassKind::kNoisy},
}};

using PassSet = std::bitset<kPassCount>;

constexpr const PassInfo& info(Pass pass) { return kPasses[size_t(pass)]; }

// The pass of that name; Pass::kCount when there is none.
constexpr Pass find_pass(std::string_view name) {
  for (int i = 0; i < kPassCount; ++i)
    if (kPasses[size_t(i)].name == name) return Pass(i);
  return Pass::kCount;
}

// `wanted` and what its passes are divided by.
inline PassSet with_divisors(PassSet wanted) {
  for (int i = 0; i < kPassCount; ++i)
    if (wanted[size_t(i)]) wanted.set(size_t(kPasses[size_t(i)].divisor));
  wanted.set(size_t(Pass::kCombined));
  return wanted;
}

}  // namespace panoptes::film
