// An OpenGL 4.5 core context without a window, through EGL.
//
// A device with a GPU is tried first (EGL_PLATFORM_DEVICE_EXT), then Mesa's surfaceless platform,
// which is llvmpipe on a machine without one. The context belongs to the thread that made it: make
// it, use it and destroy it there. The EGL display is never terminated, since Blender may share it.
#pragma once

#include <memory>
#include <string>

namespace panoptes::gl {

// What the driver said of itself, queried once.
struct DeviceInfo {
  std::string renderer;     // GL_RENDERER, for people
  std::string vendor;
  std::string version;
  bool software = false;    // llvmpipe: timer queries lie, branches skip no arithmetic
  int max_texture_size = 0;
  int max_array_layers = 0;
  int max_texture_buffer_texels = 0;
  int max_texture_units = 0;  // per stage
};

struct ContextOptions {
  bool prefer_software = false;  // skip the devices with a GPU
};

class Context {
 public:
  // Makes the context current on this thread. Throws Error when no driver offers OpenGL 4.5 or
  // when its limits are below what every shader here relies on.
  explicit Context(const ContextOptions& options = {});
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  const DeviceInfo& device() const { return device_; }

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
  DeviceInfo device_;
};

// Throws Error if GL has recorded an error since the last call; `where` names the pass.
void check_errors(const char* where);

}  // namespace panoptes::gl
