// The word that a technique's pure decide(facts, settings) answers with: what it would run for this
// scene, and why. Needs no GL.
#pragma once

#include <string>
#include <vector>

namespace panoptes::plan {

struct Effect {
  std::string name;    // stable, for scripts: "sun_shadows"
  bool runs = false;
  std::string reason;  // in words an artist understands
  bool by_choice = false;  // skipped because of a setting, not of the scene: forcing leaves it alone
};

using Effects = std::vector<Effect>;

// Whether the effect of that name runs; an unknown name is a mistake of ours and throws Error.
bool runs(const Effects& effects, const std::string& name);

}  // namespace panoptes::plan
