#include "core/finish/open_image_denoise.h"

#include <dlfcn.h>

#include <cstdlib>
#include <utility>

namespace hyades::core {

/// What is used of its C interface (oidn.h of both versions).
struct OpenImageDenoise::Functions {
  void* (*new_device)(int type) = nullptr;
  void (*commit_device)(void* device) = nullptr;
  int (*device_error)(void* device, const char** message) = nullptr;
  void (*release_device)(void* device) = nullptr;
  void* (*new_filter)(void* device, const char* type) = nullptr;
  void (*set_image)(void* filter, const char* name, void* pixels, int format, size_t width,
                    size_t height, size_t offset, size_t pixel_stride, size_t row_stride) = nullptr;
  void (*set_flag)(void* filter, const char* name, bool value) = nullptr;
  void (*commit_filter)(void* filter) = nullptr;
  void (*execute_filter)(void* filter) = nullptr;
  void (*release_filter)(void* filter) = nullptr;
};

namespace {

constexpr int kCpu = 1;
constexpr int kFloat3 = 3;

template <class F>
bool find(void* library, const char* name, F& function) {
  function = reinterpret_cast<F>(dlsym(library, name));
  return function != nullptr;
}

/// The library, which stays loaded: it has threads of its own. Null and what the loader said where
/// it is not there.
void* open_library(std::string& complaint) {
  const char* const named = std::getenv("HYADES_OIDN");
  if (named != nullptr && *named != '\0') {
    void* library = dlopen(named, RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) complaint = std::string("HYADES_OIDN: ") + dlerror();
    return library;
  }
  for (const char* name : {"libOpenImageDenoise.so.2", "libOpenImageDenoise.so.1"}) {
    if (void* library = dlopen(name, RTLD_NOW | RTLD_LOCAL)) return library;
  }
  complaint =
      "there is no libOpenImageDenoise.so.2 or .so.1 where libraries are looked for (HYADES_OIDN "
      "may name its file)";
  return nullptr;
}

void set_picture(void (*set_image)(void*, const char*, void*, int, size_t, size_t, size_t, size_t,
                                   size_t),
                 void* filter, const char* name, const std::vector<Rgb>& pixels, int width,
                 int height) {
  // The library only reads what is not its output.
  set_image(filter, name, const_cast<Rgb*>(pixels.data()), kFloat3, static_cast<size_t>(width),
            static_cast<size_t>(height), 0, sizeof(Rgb), sizeof(Rgb) * static_cast<size_t>(width));
}

}  // namespace

Result<OpenImageDenoise> OpenImageDenoise::load() {
  std::string complaint;
  void* const library = open_library(complaint);
  if (library == nullptr) return Error{"Open Image Denoise cannot be used: " + complaint};
  auto f = std::make_shared<Functions>();
  const bool whole = find(library, "oidnNewDevice", f->new_device) &&
                     find(library, "oidnCommitDevice", f->commit_device) &&
                     find(library, "oidnGetDeviceError", f->device_error) &&
                     find(library, "oidnReleaseDevice", f->release_device) &&
                     find(library, "oidnNewFilter", f->new_filter) &&
                     find(library, "oidnSetSharedFilterImage", f->set_image) &&
                     (find(library, "oidnSetFilterBool", f->set_flag) ||
                      find(library, "oidnSetFilter1b", f->set_flag)) &&
                     find(library, "oidnCommitFilter", f->commit_filter) &&
                     find(library, "oidnExecuteFilter", f->execute_filter) &&
                     find(library, "oidnReleaseFilter", f->release_filter);
  if (!whole) return Error{"Open Image Denoise cannot be used: the library found is another one"};
  return OpenImageDenoise(std::move(f));
}

Result<std::vector<Rgb>> OpenImageDenoise::run(const Picture& picture) const {
  const Functions& f = *functions_;
  const char* message = nullptr;
  void* const device = f.new_device(kCpu);
  if (device == nullptr) {
    f.device_error(nullptr, &message);
    return Error{std::string("Open Image Denoise: ") +
                 (message != nullptr ? message : "no device")};
  }
  f.commit_device(device);
  std::vector<Rgb> out(picture.color.size());
  void* const filter = f.new_filter(device, "RT");
  if (filter != nullptr) {
    const auto set = [&](const char* name, const std::vector<Rgb>& pixels) {
      set_picture(f.set_image, filter, name, pixels, picture.width, picture.height);
    };
    set("color", picture.color);
    // The network takes normals only beside an albedo.
    if (!picture.albedo.empty()) {
      set("albedo", picture.albedo);
      if (!picture.normal.empty()) set("normal", picture.normal);
    }
    set("output", out);
    f.set_flag(filter, "hdr", true);
    f.commit_filter(filter);
    f.execute_filter(filter);
    f.release_filter(filter);
  }
  const int failed = f.device_error(device, &message);
  const std::string said = message != nullptr ? message : "it failed without saying why";
  f.release_device(device);
  if (failed != 0 || filter == nullptr) return Error{"Open Image Denoise: " + said};
  return out;
}

}  // namespace hyades::core
