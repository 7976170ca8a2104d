// What a picture that shows one pass in place of Combined can do without.
#pragma once

#include "film/passes.h"
#include "path_tracer/settings.h"
#include "plan/effect.h"

namespace panoptes::plan {

// Switches off what Combined needs and `shown` does not. What tells of surfaces stays as it is, so that
// materials' programs are those that Combined has compiled. Paths can only be shorter.
void leave_out(Effects& effects, film::Pass shown, bool path_tracing);

// Limits of paths that find all of `shown`.
path_tracer::Settings shortened(path_tracer::Settings paths, film::Pass shown);

}  // namespace panoptes::plan
