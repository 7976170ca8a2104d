#include "plan/effect.h"

#include "base/error.h"

namespace panoptes::plan {

bool runs(const Effects& effects, const std::string& name) {
  for (const Effect& effect : effects)
    if (effect.name == name) return effect.runs;
  fail("the frame plan does not know the effect '{}': please report it", name);
}

}  // namespace panoptes::plan
