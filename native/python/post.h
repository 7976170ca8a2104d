// Changes of an engine's scene that own what they need.
#pragma once

#include "engine/engine.h"

#include <memory>
#include <type_traits>
#include <utility>

namespace panoptes::python {

// Hands `change` over without waiting (Engine::post). It may own what can be moved only.
template <class F>
void post(engine::Engine& engine, F&& change) {
  auto owned = std::make_shared<std::decay_t<F>>(std::forward<F>(change));
  engine.post([owned](scene::Scene& scene) { (*owned)(scene); });
}

}  // namespace panoptes::python
