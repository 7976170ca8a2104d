// Lets one header be read by C++ and by GLSL. Structs shared by both hold only 4-byte scalars,
// four-component vectors and 4x4 matrices, so that std140, std430 and C++ agree on their layout.
#pragma once

#ifdef __cplusplus
#include <glm/glm.hpp>
namespace panoptes::shared {
using glm::ivec4;
using glm::mat4;
using glm::uvec4;
using glm::vec4;
using uint = uint32_t;
}  // namespace panoptes::shared
#define SHARED_BEGIN namespace panoptes::shared {
#define SHARED_END }
#define SHARED_ASSERT_SIZE(type, bytes) static_assert(sizeof(type) == (bytes));
#else
#define SHARED_BEGIN
#define SHARED_END
#define SHARED_ASSERT_SIZE(type, bytes)
#endif
