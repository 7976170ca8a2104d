#include "film/display.h"

namespace panoptes::film {

std::vector<float> display(Pass pass, std::span<const float> pixels) {
  if (info(pass).channels == 4) return {pixels.begin(), pixels.end()};
  const bool directions = pass == Pass::kNormal;
  std::vector<float> picture(pixels.size() / 3 * 4, 1.0f);
  for (size_t i = 0; i < pixels.size(); ++i)
    picture[i / 3 * 4 + i % 3] = directions ? 0.5f + 0.5f * pixels[i] : pixels[i];
  return picture;
}

}  // namespace panoptes::film
