// What nobody needs any more leaves the disk.
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <unordered_set>
#include <utility>

#include "coordinator/controller/controller.h"
#include "farm/wire.h"

namespace hyades::coordinator {
namespace {

namespace fs = std::filesystem;

constexpr uint32_t kPage = 64;  // jobs whose files are looked at without a pause for others
constexpr Duration kShortestRound = std::chrono::milliseconds(100);
constexpr Duration kLongestRound = std::chrono::minutes(10);

/// The jobs that have a folder in `folder`.
std::vector<uint64_t> numbered_folders(const std::string& folder) {
  std::vector<uint64_t> ids;
  std::error_code failed;
  for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed)) {
    const std::string name = at->path().filename().string();
    uint64_t id = 0;
    const auto read = std::from_chars(name.data(), name.data() + name.size(), id);
    if (read.ec == std::errc() && read.ptr == name.data() + name.size()) ids.push_back(id);
  }
  return ids;
}

}  // namespace

/// Folders of jobs that are deleted, and films of jobs that are done: a crash came between.
void Controller::sweep_folders() {
  for (const uint64_t id : numbered_folders(options_.folder + "/films")) {
    const auto state = store_->state(id);
    if (stop_ || !state) return;
    std::error_code ignored;
    if (!*state || **state == StoredState::done) fs::remove_all(films_folder(id), ignored);
  }
  for (const uint64_t id : numbered_folders(options_.folder + "/outputs")) {
    const auto state = store_->state(id);
    if (stop_ || !state) return;
    std::error_code ignored;
    if (!*state) fs::remove_all(output_folder(id), ignored);
  }
}

/// Takes the files of all jobs with ids above `after`, which becomes the last one's, out of
/// `names`.
core::Status Controller::spare_needed(std::unordered_set<std::string>& names, uint64_t& after) {
  while (!names.empty() && !stop_) {
    const auto page = store_->specs(after, kPage);
    if (!page) return page.error();
    for (const StoredSpec& stored : *page) {
      v1::JobSpec spec;
      if (!spec.ParseFromString(stored.spec)) {
        return core::Error{"a job's record is damaged: nobody knows which files it needs"};
      }
      for (const v1::JobFile& file : spec.files()) {
        if (const auto digest = farm::digest_from_wire(file.sha256())) {
          names.erase(core::to_hex(*digest));
        }
      }
      after = stored.id;
    }
    if (page->size() < kPage) return {};
  }
  return {};
}

/// Removes the assets that no job needs and that nobody has used for `grace`.
core::Status Controller::sweep_assets(Duration grace) {
  const uint64_t changes = asset_changes_ + assets_->commits();
  if (changes == swept_changes_) return {};
  std::unordered_set<std::string> names;
  for (std::string& name : assets_->names()) names.insert(std::move(name));
  uint64_t seen = 0;
  if (core::Status spared = spare_needed(names, seen); !spared) return spared;
  bool all = !stop_;
  if (!names.empty()) {
    // No submission comes between the last look and the removal: it finds its files here, or not.
    const std::lock_guard one(submit_mutex_);
    if (core::Status spared = spare_needed(names, seen); !spared) return spared;
    for (const std::string& name : names) {
      if (stop_) return {};
      all = assets_->remove_unused(name, grace) && all;
    }
  }
  if (all) swept_changes_ = changes;
  return {};
}

void Controller::sweep_loop() {
  sweep_folders();
  const Duration round = std::clamp(options_.asset_grace / 4, kShortestRound, kLongestRound);
  std::unique_lock lock(mutex_);
  while (!stop_) {
    lock.unlock();
    // What fails now (a full disk, a damaged record) is tried again; nothing was removed wrongly.
    (void)sweep_assets(options_.asset_grace);
    lock.lock();
    sweep_wake_.wait_for(lock, round, [&] { return stop_.load(); });
  }
}

}  // namespace hyades::coordinator
