#include "engine/tracers.h"

#include "base/error.h"
#include "bvh_tracer/bvh_tracer.h"
#include "primitive_tracer/orthographic_tracer.h"

namespace panoptes::engine {

std::unique_ptr<tracing::Tracer> make_tracer(std::string_view name, const gl::DeviceInfo& device) {
  if (name == "orthographic") return std::make_unique<primitive_tracer::OrthographicTracer>();
  if (name == "bvh") return std::make_unique<bvh_tracer::BvhTracer>(device);
  fail("there is no ray tracer '{}': choose 'orthographic' or 'bvh'", name);
}

}  // namespace panoptes::engine
