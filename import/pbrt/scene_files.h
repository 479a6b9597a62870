#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/assets.h"

namespace hyades::core::pbrt {

/// Opens the files that a scene names. All are named relative to the folder of the scene's main
/// file, and lie in it or below.
class SceneFiles {
 public:
  SceneFiles(AssetResolver& files, std::string main);

  /// The bytes of a file beside the scene's; unpacked where they are gzip's, to kMostUnpacked at
  /// most.
  Result<Bytes> open(const std::string& reference) const;
  bool exists(const std::string& reference) const;
  const std::string& main() const { return main_; }

  static constexpr size_t kMostUnpacked = size_t{4} << 30;

 private:
  AssetResolver& files_;
  std::string main_;
};

}  // namespace hyades::core::pbrt
