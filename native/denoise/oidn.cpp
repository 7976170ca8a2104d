#include "denoise/oidn.h"

#include "base/error.h"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <memory>

namespace panoptes::denoise {

namespace {

// Of the library's C interface, what both versions have (OpenImageDenoise/oidn.h).
struct Device;
struct Filter;
constexpr int kCpu = 1;     // it reads our memory, which those of graphics cards may not
constexpr int kFloat3 = 3;  // the format of pixels

struct Library {
  Device* (*new_device)(int type);
  void (*commit_device)(Device*);
  int (*device_error)(Device*, const char** message);
  void (*release_device)(Device*);
  Filter* (*new_filter)(Device*, const char* type);
  void (*set_image)(Filter*, const char* name, void* pixels, int format, size_t width, size_t height, size_t offset,
                    size_t pixel_stride, size_t row_stride);
  void (*set_bool)(Filter*, const char* name, bool value);
  void (*commit_filter)(Filter*);
  void (*execute_filter)(Filter*);
  void (*release_filter)(Filter*);
};

template <class F>
bool find(void* handle, F& function, std::initializer_list<const char*> names) {
  for (const char* name : names)
    if (void* found = dlsym(handle, name)) {
      function = reinterpret_cast<F>(found);
      return true;
    }
  return false;
}

std::unique_ptr<Library> load(const char* name) {
  void* handle = dlopen(name, RTLD_NOW | RTLD_LOCAL);
  if (!handle) return nullptr;
  auto library = std::make_unique<Library>();
  const bool complete = find(handle, library->new_device, {"oidnNewDevice"}) &&
                        find(handle, library->commit_device, {"oidnCommitDevice"}) &&
                        find(handle, library->device_error, {"oidnGetDeviceError"}) &&
                        find(handle, library->release_device, {"oidnReleaseDevice"}) &&
                        find(handle, library->new_filter, {"oidnNewFilter"}) &&
                        find(handle, library->set_image, {"oidnSetSharedFilterImage"}) &&
                        find(handle, library->set_bool, {"oidnSetFilterBool", "oidnSetFilter1b"}) &&
                        find(handle, library->commit_filter, {"oidnCommitFilter"}) &&
                        find(handle, library->execute_filter, {"oidnExecuteFilter"}) &&
                        find(handle, library->release_filter, {"oidnReleaseFilter"});
  if (complete) return library;
  dlclose(handle);
  return nullptr;
}

// Null where there is none.
const Library* library() {
  static const std::unique_ptr<Library> found = [] {
    if (const char* named = std::getenv("PANOPTES_OIDN")) return load(named);
    for (const char* name : {"libOpenImageDenoise.so.2", "libOpenImageDenoise.so.1", "libOpenImageDenoise.so"})
      if (std::unique_ptr<Library> loaded = load(name)) return loaded;
    return std::unique_ptr<Library>();
  }();
  return found.get();
}

std::vector<float> colours(std::span<const float> pixels) {
  std::vector<float> rgb(pixels.size() / 4 * 3);
  for (size_t i = 0; i < rgb.size(); ++i) rgb[i] = pixels[i / 3 * 4 + i % 3];
  return rgb;
}

}  // namespace

bool has_oidn() { return library() != nullptr; }

std::vector<float> denoise_with_oidn(const Picture& picture) {
  const Library* oidn = library();
  if (!oidn) fail("OpenImageDenoise was not found: install it, or choose another denoiser");
  const std::unique_ptr<Device, void (*)(Device*)> device(oidn->new_device(kCpu), oidn->release_device);
  const auto check = [&] {
    const char* message = nullptr;
    if (!device || oidn->device_error(device.get(), &message) != 0)
      fail("OpenImageDenoise failed ({}): choose another denoiser", message ? message : "it gives no reason");
  };
  check();
  oidn->commit_device(device.get());
  check();
  const std::unique_ptr<Filter, void (*)(Filter*)> filter(oidn->new_filter(device.get(), "RT"), oidn->release_filter);
  check();
  std::vector<float> colour = colours(picture.noisy), albedo = picture.albedo, normals = picture.normals;
  std::vector<float> result(colour.size());
  // It wants shares of light; some models of surfaces scatter a little more than they get.
  for (float& a : albedo) a = std::clamp(a, 0.0f, 1.0f);
  const auto image = [&](const char* name, std::vector<float>& pixels) {
    oidn->set_image(filter.get(), name, pixels.data(), kFloat3, size_t(picture.width), size_t(picture.height), 0, 0, 0);
  };
  image("color", colour);
  image("albedo", albedo);
  image("normal", normals);
  image("output", result);
  oidn->set_bool(filter.get(), "hdr", true);
  oidn->commit_filter(filter.get());
  oidn->execute_filter(filter.get());
  check();
  std::vector<float> pixels(picture.noisy.begin(), picture.noisy.end());
  for (size_t i = 0; i < result.size(); ++i) pixels[i / 3 * 4 + i % 3] = result[i];
  return pixels;
}

}  // namespace panoptes::denoise
