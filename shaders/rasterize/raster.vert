// Places the vertices of every draw record of a view. Serves the camera and all shadow maps.
#include "gpu_scene/geometry.glsl"

layout(location = 0) in vec3 position;  // object space, metres
layout(location = 1) in uvec4 record;   // DrawRecord, one an instance

flat out uvec4 drawn;  // x: index of the record + 1; y: instance; z: first triangle

void main() {
  Transform transform = fetch_transform(record.x, view.world_origin.xyz);
  vec3 relative = transform.linear * position + transform.translation;
  drawn = uvec4(record.w + 1u, record.x, record.z, 0u);
  gl_Position = view.clip_from_relative * vec4(relative, 1.0);
}
