#include "core/import/pbrt/scene_files.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "core/base/gunzip.h"
#include "core/base/text.h"

namespace hyades::core::pbrt {

SceneFiles::SceneFiles(AssetResolver& files, std::string main)
    : files_(files), main_(std::move(main)) {}

Result<std::string> SceneFiles::inside(const std::string& reference) {
  if (reference.empty()) return Error{"the name of the file is empty"};
  if (reference.front() == '/' || reference.find('\0') != std::string::npos) {
    return Error{"'" + reference + "' is not a path in the scene's folder"};
  }
  const std::string folded = resolve_reference(reference);
  if (folded == ".." || folded.starts_with("../")) {
    return Error{"'" + reference + "' leaves the scene's folder"};
  }
  return folded;
}

Result<Bytes> SceneFiles::open(const std::string& reference) const {
  auto path = inside(reference);
  if (!path) return path.error();
  auto bytes = files_.open(*path, main_);
  if (!bytes) return bytes.error();
  if (!is_gzip(bytes->span())) return bytes;
  auto plain = gunzip(bytes->span(), std::min(kMostUnpacked, unpacked_limit(bytes->size())));
  if (!plain) return plain.error().in(*path);
  return plain;
}

bool SceneFiles::exists(const std::string& reference) const {
  auto path = inside(reference);
  return path.ok() && files_.exists(resolve_reference(*path, main_));
}

}  // namespace hyades::core::pbrt
