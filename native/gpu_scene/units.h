// Texture units that the geometry and the materials are bound to (gpu_scene/*.glsl).
#pragma once

namespace panoptes::gpu_scene {

constexpr int kVertexUnit = 0, kTriangleUnit = 1, kNormalUnit = 2, kAttributeUnit = 3,
              kInstanceUnit = 4, kTableUnit = 5, kParamUnit = 6, kFreeUnit = 7, kImageUnit = 8;

}  // namespace panoptes::gpu_scene
