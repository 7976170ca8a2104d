#pragma once

#include "film/passes.h"
#include "plan/effect.h"

namespace panoptes::film {

// One effect a pass: it runs when the view layer or the caller asks for it.
plan::Effects decide(const PassSet& wanted);

}  // namespace panoptes::film
