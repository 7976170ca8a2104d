#include "gl/context.h"

#include "base/error.h"
#include "gl/counters.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <array>
#include <cstring>
#include <iterator>
#include <vector>

namespace panoptes::gl {

Counters& counters() {
  static Counters instance;
  return instance;
}

struct Context::Handles {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
};

namespace {

constexpr const char* kRemedy =
    "install a driver with OpenGL 4.5 (on Debian: libegl1, libegl-mesa0 and libgl1-mesa-dri)";

// Displays in the order of preference: every EGL device that is not a software rasteriser, then
// the surfaceless platform.
std::vector<EGLDisplay> candidate_displays(const ContextOptions& options) {
  std::vector<EGLDisplay> displays;
  const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  const std::string extensions = client ? client : "";
  const bool has_devices = extensions.find("EGL_EXT_platform_device") != std::string::npos &&
                           extensions.find("EGL_EXT_device_enumeration") != std::string::npos;
  if (has_devices && !options.prefer_software) {
    std::array<EGLDeviceEXT, 16> devices{};
    EGLint count = 0;
    eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count);
    for (EGLint i = 0; i < count; ++i) {
      const char* device = eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS);
      if (device && std::strstr(device, "EGL_MESA_device_software")) continue;
      displays.push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr));
    }
  }
  if (extensions.find("EGL_MESA_platform_surfaceless") != std::string::npos)
    displays.push_back(
        eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
  return displays;
}

EGLContext try_context(EGLDisplay display) {
  EGLint major = 0, minor = 0;
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, &major, &minor)) return EGL_NO_CONTEXT;
  if (!eglBindAPI(EGL_OPENGL_API)) return EGL_NO_CONTEXT;  // per thread
  // The last pair makes a driver that restarts tell so; not all can.
  const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5,
                               EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                               EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY, EGL_LOSE_CONTEXT_ON_RESET,
                               EGL_NONE};
  constexpr size_t kSilent = std::size(attributes) - 3;
  EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
  if (context == EGL_NO_CONTEXT) {
    std::vector<EGLint> silent(attributes, attributes + kSilent);
    silent.push_back(EGL_NONE);
    context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, silent.data());
  }
  if (context == EGL_NO_CONTEXT) return EGL_NO_CONTEXT;
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
    eglDestroyContext(display, context);
    return EGL_NO_CONTEXT;
  }
  return context;
}

int integer(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}

std::string text(GLenum name) {
  const auto* value = reinterpret_cast<const char*>(glGetString(name));
  return value ? value : "";
}

// A limit that every shader here relies on, by the name that the driver's documentation uses.
struct Requirement {
  GLenum name;
  const char* label;
  int least;
};

void require_limits(const DeviceInfo& device) {
  const Requirement requirements[] = {
      {GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS, "shader storage blocks a compute stage", 16},
      {GL_MAX_COMPUTE_SHARED_MEMORY_SIZE, "bytes of shared memory", 32 * 1024},
      {GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS, "invocations a work group", 256},
      {GL_MAX_COMPUTE_IMAGE_UNIFORMS, "images a compute stage", 8},
      {GL_MAX_COLOR_ATTACHMENTS, "colour attachments", 8},
      {GL_MAX_3D_TEXTURE_SIZE, "texels along a 3D texture", 2048},
      {GL_MAX_TEXTURE_IMAGE_UNITS, "texture units a stage", 16},
      {GL_MAX_TEXTURE_BUFFER_SIZE, "texels a buffer texture", 1 << 26},
  };
  for (const Requirement& r : requirements)
    if (integer(r.name) < r.least)
      fail("the graphics driver ({}) offers {} {} where Panoptes needs {}: update the driver, or "
           "run with LIBGL_ALWAYS_SOFTWARE=1 to render on the processor",
           device.renderer, integer(r.name), r.label, r.least);
}

}  // namespace

Context::Context(const ContextOptions& options) : handles_(std::make_unique<Handles>()) {
  for (EGLDisplay display : candidate_displays(options)) {
    EGLContext context = try_context(display);
    if (context == EGL_NO_CONTEXT) continue;
    handles_->display = display;
    handles_->context = context;
    break;
  }
  if (handles_->context == EGL_NO_CONTEXT)
    fail("no graphics driver with OpenGL 4.5 was found through EGL: {}", kRemedy);

  device_.renderer = text(GL_RENDERER);
  device_.vendor = text(GL_VENDOR);
  device_.version = text(GL_VERSION);
  device_.software = device_.renderer.find("llvmpipe") != std::string::npos ||
                     device_.renderer.find("softpipe") != std::string::npos;
  device_.max_texture_size = integer(GL_MAX_TEXTURE_SIZE);
  device_.max_array_layers = integer(GL_MAX_ARRAY_TEXTURE_LAYERS);
  device_.max_texture_buffer_texels = integer(GL_MAX_TEXTURE_BUFFER_SIZE);
  device_.max_texture_units = integer(GL_MAX_TEXTURE_IMAGE_UNITS);
  try {
    require_limits(device_);
  } catch (...) {
    eglMakeCurrent(handles_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(handles_->display, handles_->context);
    throw;
  }

  // One convention for every pass: depth 0..1 in clip space, for float depth buffers.
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
}

Context::~Context() {
  if (handles_->context == EGL_NO_CONTEXT) return;
  eglMakeCurrent(handles_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(handles_->display, handles_->context);
  eglReleaseThread();
}

void check_errors(const char* where) {
  const GLenum error = glGetError();
  if (error == GL_CONTEXT_LOST || glGetGraphicsResetStatus() != GL_NO_ERROR)
    fail_driver("the graphics driver has restarted in '{}': render again; if that happens again, update it, or lower the "
                "resolution or the samples",
                where);
  if (error == GL_NO_ERROR) return;
  // One after the other, but a driver that is lost may never end.
  for (int i = 0; i < 100 && glGetError() != GL_NO_ERROR; ++i) {
  }
  if (error == GL_OUT_OF_MEMORY)
    fail_driver("the graphics driver ran out of memory in '{}': lower the resolution or the shadow "
                "resolution, or close other programs",
                where);
  fail_driver("the graphics driver reported error 0x{:04x} in '{}': please report it with the scene and "
       "the driver's version",
       error, where);
}

}  // namespace panoptes::gl
