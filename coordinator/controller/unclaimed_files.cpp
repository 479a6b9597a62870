#include "coordinator/controller/unclaimed_files.h"

#include <algorithm>
#include <vector>

namespace hyades::coordinator {
namespace {

/// What a file takes at least, so that a million empty ones are not nothing.
constexpr uint64_t kLeast = 4096;

}  // namespace

void UnclaimedFiles::add(const std::string& owner, const std::string& name, uint64_t size) {
  const uint64_t bytes = std::max(size, kLeast);
  const core::MutexLock lock(mutex_);
  if (files_.try_emplace(name, Claimable{owner, bytes}).second) bytes_[owner] += bytes;
}

void UnclaimedFiles::remove(const std::string& name) {
  const core::MutexLock lock(mutex_);
  const auto found = files_.find(name);
  if (found == files_.end()) return;
  const auto whose = bytes_.find(found->second.owner);
  whose->second -= found->second.bytes;
  if (whose->second == 0) bytes_.erase(whose);
  files_.erase(found);
}

void UnclaimedFiles::keep_only(const std::unordered_set<std::string>& names) {
  std::vector<std::string> others;
  {
    const core::MutexLock lock(mutex_);
    for (const auto& [name, claimable] : files_) {
      if (!names.contains(name)) others.push_back(name);
    }
  }
  for (const std::string& name : others) remove(name);
}

uint64_t UnclaimedFiles::bytes_of(const std::string& owner) const {
  const core::MutexLock lock(mutex_);
  const auto found = bytes_.find(owner);
  return found == bytes_.end() ? 0 : found->second;
}

}  // namespace hyades::coordinator
