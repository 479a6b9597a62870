// A library with the part of Open Image Denoise's interface that Hyades uses, which does nothing
// sensible with pictures: output = color + 10 albedo + 100 normal where "hdr" is set. For tests.

#include <cstddef>
#include <cstring>
#include <map>
#include <string>

namespace {

struct View {
  char* pixels = nullptr;
  size_t width = 0, height = 0, offset = 0, pixel_stride = 0, row_stride = 0;

  float* at(size_t x, size_t y) const {
    return reinterpret_cast<float*>(pixels + offset + y * row_stride + x * pixel_stride);
  }
};

struct Device {
  bool committed = false;
  std::string error;
};

struct Filter {
  Device* device = nullptr;
  std::map<std::string, View> images;
  bool hdr = false;
  bool committed = false;
};

}  // namespace

extern "C" {

void* oidnNewDevice(int type) { return type == 1 ? new Device : nullptr; }
void oidnCommitDevice(void* device) { static_cast<Device*>(device)->committed = true; }
int oidnGetDeviceError(void* device, const char** message) {
  auto* d = static_cast<Device*>(device);
  if (d == nullptr || d->error.empty()) return 0;
  *message = d->error.c_str();
  return 1;
}
void oidnReleaseDevice(void* device) { delete static_cast<Device*>(device); }

void* oidnNewFilter(void* device, const char* type) {
  auto* d = static_cast<Device*>(device);
  if (!d->committed || std::strcmp(type, "RT") != 0) return nullptr;
  auto* filter = new Filter;
  filter->device = d;
  return filter;
}
void oidnSetSharedFilterImage(void* filter, const char* name, void* pixels, int format,
                              size_t width, size_t height, size_t offset, size_t pixel_stride,
                              size_t row_stride) {
  if (format != 3) return;
  static_cast<Filter*>(filter)->images[name] = {
      static_cast<char*>(pixels), width, height, offset, pixel_stride, row_stride};
}
void oidnSetFilterBool(void* filter, const char* name, bool value) {
  if (std::strcmp(name, "hdr") == 0) static_cast<Filter*>(filter)->hdr = value;
}
void oidnCommitFilter(void* filter) { static_cast<Filter*>(filter)->committed = true; }
void oidnExecuteFilter(void* filter) {
  auto& f = *static_cast<Filter*>(filter);
  const View color = f.images["color"];
  const View output = f.images["output"];
  if (!f.committed || !f.hdr || color.pixels == nullptr || output.pixels == nullptr) {
    f.device->error = "it was not set up";
  } else if (color.width == 13) {
    f.device->error = "13 is an unlucky number";
  }
  for (size_t y = 0; f.device->error.empty() && y < color.height; ++y) {
    for (size_t x = 0; x < color.width; ++x) {
      for (size_t c = 0; c < 3; ++c) {
        float value = color.at(x, y)[c];
        if (f.images.count("albedo") != 0) value += 10.0F * f.images["albedo"].at(x, y)[c];
        if (f.images.count("normal") != 0) value += 100.0F * f.images["normal"].at(x, y)[c];
        output.at(x, y)[c] = value;
      }
    }
  }
}
void oidnReleaseFilter(void* filter) { delete static_cast<Filter*>(filter); }
}
