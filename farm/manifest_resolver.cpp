#include "farm/manifest_resolver.h"

#include <fmt/format.h>

namespace hyades::farm {

using core::AssetRecord;
using core::Bytes;
using core::Error;
using core::Result;

namespace {

std::map<std::string, AssetRecord> by_reference(const std::vector<AssetRecord>& manifest) {
  std::map<std::string, AssetRecord> files;
  for (const AssetRecord& record : manifest) files.emplace(record.reference, record);
  return files;
}

}  // namespace

ManifestResolver::ManifestResolver(const std::vector<AssetRecord>& manifest, ContentStore& store)
    : files_(by_reference(manifest)), store_(store) {}

Result<Bytes> ManifestResolver::open(const std::string& reference, const std::string& from) {
  if (reference.empty()) return Error{"empty file name"};
  const auto found = files_.find(core::resolve_reference(reference, from));
  if (found == files_.end()) {
    return Error{reference + ": not among the files that came with the job"};
  }
  const AssetRecord& record = found->second;
  auto bytes = store_.read(record.sha256);
  if (!bytes) return bytes.error().in(reference);
  if (bytes->size() != record.size) {
    return Error{fmt::format("{}: {} bytes, the job's list of files says {}", reference,
                             bytes->size(), record.size)};
  }
  return bytes;
}

bool ManifestResolver::exists(const std::string& reference) {
  return files_.contains(core::resolve_reference(reference));
}

}  // namespace hyades::farm
