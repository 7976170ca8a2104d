// Stands in for OpenImageDenoise (its C interface, version 2): half of the colour plus the albedo, minus the normal. Fails
// where the picture's first colour is negative.
#include <cstddef>
#include <map>
#include <string>

namespace {

struct Device {
  const char* error = nullptr;
};
struct Filter {
  Device* device;
  std::map<std::string, float*> images;
  size_t pixels = 0;
  bool hdr = false, committed = false;
};

}  // namespace

extern "C" {

Device* oidnNewDevice(int) { return new Device; }
void oidnCommitDevice(Device*) {}
int oidnGetDeviceError(Device* device, const char** message) {
  *message = device->error;
  device->error = nullptr;
  return *message ? 2 : 0;
}
void oidnReleaseDevice(Device* device) { delete device; }
Filter* oidnNewFilter(Device* device, const char*) { return new Filter{device, {}, 0, false, false}; }
void oidnSetSharedFilterImage(Filter* filter, const char* name, float* pixels, int, size_t width, size_t height, size_t,
                              size_t, size_t) {
  filter->images[name] = pixels;
  filter->pixels = width * height;
}
void oidnSetFilterBool(Filter* filter, const char* name, bool value) { filter->hdr |= value && std::string(name) == "hdr"; }
void oidnCommitFilter(Filter* filter) { filter->committed = true; }
void oidnExecuteFilter(Filter* filter) {
  auto& images = filter->images;
  if (!filter->committed || !filter->hdr || images.size() != 4 || images["color"][0] < 0) {
    filter->device->error = "a negative colour";
    return;
  }
  for (size_t i = 0; i < 3 * filter->pixels; ++i)
    images["output"][i] = 0.5f * images["color"][i] + images["albedo"][i] - images["normal"][i];
}
void oidnReleaseFilter(Filter* filter) { delete filter; }

}  // extern "C"
