// Texture units and uniform blocks of the radiance cache's own programs.
#pragma once

namespace panoptes::radiance_cache {

constexpr int kCellsUnit = 3, kWordsUnit = 4, kSurfelsUnit = 5, kReachUnit = 6, kMetSidesUnit = 7;
constexpr int kVolumesBlock = 1, kCellsBlock = 2;

}  // namespace panoptes::radiance_cache
