// A scene and a request in one file, so that benchmarks and GPU checks run without Blender.
#pragma once

#include "engine/request.h"
#include "scene/scene.h"

#include <string>

namespace panoptes::engine {

// Writes through a temporary file, so that a failed write leaves none. Throws Error.
void write_snapshot(const std::string& path, const scene::Scene& scene,
                    const RenderRequest& request);

// Fills an empty scene. Throws Error when the file is missing, cut off or of another version.
RenderRequest read_snapshot(const std::string& path, scene::Scene& scene);

}  // namespace panoptes::engine
