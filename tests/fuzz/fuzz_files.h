#pragma once

#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/assets.h"
#include "tests/support/exact_bytes.h"

namespace hyades::fuzz {

using test::exact_bytes;

/// Files in memory, for readers that open others.
class Files : public core::AssetResolver {
 public:
  Files(const std::string& name, std::string_view content) { add(name, content); }

  void add(const std::string& name, std::string_view content) {
    files_[name] = exact_bytes(content);
  }

  core::Result<core::Bytes> open(const std::string& reference,
                                 const std::string& from = {}) override {
    const auto found = files_.find(core::resolve_reference(reference, from));
    if (found != files_.end()) return found->second;
    if (others_.has_value()) return *others_;
    return core::Error{"'" + reference + "' is not there"};
  }

  /// Every other file is there as well, with this content.
  void add_all_others(std::string_view content) { others_ = exact_bytes(content); }

 private:
  std::optional<core::Bytes> others_;
  std::map<std::string, core::Bytes> files_;
};

/// The text of a file of the repository, for seeds; empty where it is not there.
inline std::string source_file(const std::string& name) {
  std::ifstream file(std::string(HYADES_SOURCE) + "/" + name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The content of a file that `write` makes; empty where it could not.
template <class Write>
std::string written(const Write& write) {
  auto bytes = write();
  if (!bytes) return {};
  return std::string(bytes->chars(), bytes->size());
}

}  // namespace hyades::fuzz
