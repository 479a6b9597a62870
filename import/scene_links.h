#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "core/base/result.h"

namespace hyades::core {

/// Links of the disk that lead out of a scene's folder. A scene may name files of its own folder
/// only (within_folder()); with a link in that folder it could name any, so they are followed only
/// where somebody said so. Thread-safe; copies share what they may still look at.
class SceneLinks {
 public:
  /// Links are not looked at.
  SceneLinks() = default;
  /// `folder`: on the disk, where references begin.
  explicit SceneLinks(std::string folder)
      : folder_(std::move(folder)), left_(std::make_shared<std::atomic<int64_t>>(kMostEntries)) {}

  /// Whether `file`, as a reference that scene file `scene` names, lies in the scene's folder or
  /// below it when all links are followed. An error that names the link and says what to do. Files
  /// that are not there are none of its business; of a pattern (`<UDIM>`, `####`, in folders' names
  /// too) all are looked at that it may mean.
  Status check(const std::string& scene, const std::string& file) const;

 private:
  Status check_one(const std::string& base, const std::string& file) const;

  /// Entries of folders that are looked at for patterns, all together, those that are meant counted
  /// more often: some ten seconds. Links within a folder may lead back into it, over and over.
  static constexpr int64_t kMostEntries = int64_t{1} << 25;

  std::string folder_;
  std::shared_ptr<std::atomic<int64_t>> left_;  ///< of kMostEntries; null: links are not looked at
};

}  // namespace hyades::core
