#include "engine/tracers.h"

#include "base/error.h"
#include "primitive_tracer/orthographic_tracer.h"

namespace panoptes::engine {

std::unique_ptr<tracing::Tracer> make_tracer(std::string_view name) {
  if (name == "orthographic") return std::make_unique<primitive_tracer::OrthographicTracer>();
  fail("there is no ray tracer '{}': choose 'orthographic'", name);
}

}  // namespace panoptes::engine
