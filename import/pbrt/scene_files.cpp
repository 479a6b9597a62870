#include "import/pbrt/scene_files.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "core/base/gunzip.h"
#include "import/within_folder.h"

namespace hyades::core::pbrt {

SceneFiles::SceneFiles(AssetResolver& files, std::string main)
    : files_(files), main_(std::move(main)) {}

Result<Bytes> SceneFiles::open(const std::string& reference) const {
  auto path = within_folder(reference);
  if (!path) return path.error();
  auto bytes = files_.open(*path, main_);
  if (!bytes) return bytes.error();
  if (!is_gzip(bytes->span())) return bytes;
  auto plain = gunzip(bytes->span(), std::min(kMostUnpacked, unpacked_limit(bytes->size())));
  if (!plain) return plain.error().in(*path);
  return plain;
}

bool SceneFiles::exists(const std::string& reference) const {
  auto path = within_folder(reference);
  return path.ok() && files_.exists(resolve_reference(*path, main_));
}

}  // namespace hyades::core::pbrt
