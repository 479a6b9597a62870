#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/base/assets.h"
#include "farm/content_store.h"

namespace hyades::farm {

/// Serves the files of a job's manifest out of a content store, and nothing else: references are
/// keys of the manifest, however much they look like paths ("../x", "/etc/passwd"), and the file
/// system is never asked about them. Thread-safe; the store must outlive it.
class ManifestResolver : public core::AssetResolver {
 public:
  ManifestResolver(const std::vector<core::AssetRecord>& manifest, ContentStore& store);

  /// Errors: not in the manifest; in it, but missing or damaged in the store.
  core::Result<core::Bytes> open(const std::string& reference,
                                 const std::string& from = {}) override;

  /// Whether it is in the manifest.
  bool exists(const std::string& reference) override;

 private:
  const std::map<std::string, core::AssetRecord> files_;  ///< by resolved reference
  ContentStore& store_;
};

}  // namespace hyades::farm
