// Passes as pictures to look at.
#pragma once

#include "film/passes.h"

#include <span>
#include <vector>

namespace panoptes::film {

// Whether there is a picture of it: colours, shares and normals, but no lengths.
constexpr bool can_show(Pass pass) {
  return pass < Pass::kCount && info(pass).channels >= 3 && info(pass).kind == PassKind::kSum;
}

// RGBA of the pixels of a pass that can be shown; alpha is 1 where the pass has none. Components of normals,
// -1 .. 1, are 0 .. 1: grey is 0, as in the pictures of bent normals and in normal maps.
std::vector<float> display(Pass pass, std::span<const float> pixels);

}  // namespace panoptes::film
