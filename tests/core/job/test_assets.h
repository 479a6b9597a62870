#pragma once

#include <map>
#include <memory>
#include <string>

#include "core/base/assets.h"

namespace hyades::core {

/// Files that only exist in a test's memory.
class MemoryAssets : public AssetResolver {
 public:
  void add(const std::string& name, const std::string& content) { files_[name] = content; }

  Result<Bytes> open(const std::string& reference, const std::string& from = {}) override {
    const auto found = files_.find(resolve_reference(reference, from));
    if (found == files_.end()) return Error{reference + ": no such file"};
    auto copy = std::make_shared<const std::string>(found->second);
    return Bytes{copy, std::as_bytes(std::span(*copy))};
  }

 private:
  std::map<std::string, std::string> files_;
};

}  // namespace hyades::core
