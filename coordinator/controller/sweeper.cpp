#include "coordinator/controller/sweeper.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <mutex>
#include <thread>
#include <unordered_set>
#include <utility>
#include <vector>

#include "coordinator/film_store/remove_folder.h"
#include "farm/wire.h"

namespace hyades::coordinator {
namespace {

constexpr uint64_t kPageBytes = uint64_t{16} << 20U;  // of what jobs ask for, in memory together
/// Files that are looked at, and perhaps removed, before others may submit.
constexpr size_t kNamesAtOnce = 1000;
constexpr uint64_t kRows = 0;  // no job has this number
/// Of what is left of removed jobs, with a pause between two pieces.
constexpr uint32_t kPieceRows = 500;
constexpr uint64_t kPieceFiles = 1000;
constexpr Duration kPieceEvery = std::chrono::milliseconds(10);
constexpr Duration kOthersTurn = std::chrono::milliseconds(1);
constexpr Duration kTryAgain = std::chrono::seconds(1);
constexpr Duration kShortestRound = std::chrono::milliseconds(100);
constexpr Duration kLongestRound = std::chrono::minutes(10);

}  // namespace

void Sweeper::job_removed(uint64_t job, const std::string& owner) {
  ++changes_;
  drop_rows();
  drop_folders(job, owner);
}

/// Has the rows of removed jobs dropped, of whichever.
void Sweeper::drop_rows() {
  leftovers_.add(kRows, [this] {
    if (context_.stop) return true;
    const TimePoint now = std::chrono::steady_clock::now();
    if (now < drop_again_) return false;
    const auto more = context_.store->drop_removed(kPieceRows);
    if (!more) drop_again_ = now + kTryAgain;  // the disk is full
    return more && !*more;
  });
}

/// Has the folders of a job removed that is not in the store any more. Its number is never given to
/// another, so that nobody else needs them.
void Sweeper::drop_folders(uint64_t job, const std::string& owner) {
  leftovers_.add(
      job,
      [this, job] {
        return context_.stop || (context_.films->remove(job, kPieceFiles) &&
                                 remove_some(context_.output_folder(job), kPieceFiles));
      },
      owner);
}

/// Removes folders of jobs that are deleted, and films of jobs that are done: a crash came between.
/// Whether the store has answered for all.
bool Sweeper::sweep_folders() {
  const auto with_films = context_.films->jobs();
  return with_films && sweep_folders(*with_films, true) &&
         sweep_folders(numbered_folders(context_.options.files + "/outputs"), false);
}

bool Sweeper::sweep_folders(const std::vector<uint64_t>& jobs, bool of_films) {
  for (const uint64_t id : jobs) {
    // A job that is done may be reopened, and its films with it.
    const std::lock_guard one(context_.submissions);
    const auto state = context_.store->state(id);
    if (context_.stop || !state) return false;
    if (!*state) {
      drop_folders(id, {});
    } else if (of_films && **state == StoredState::done) {
      context_.films->remove(id, UINT64_MAX);
    }
  }
  return true;
}

/// Takes the files of all jobs with ids above `after`, which becomes the last one's, out of
/// `names`.
core::Status Sweeper::spare_needed(std::unordered_set<std::string>& names, uint64_t& after) {
  while (!names.empty() && !context_.stop) {
    const auto page = context_.store->specs(after, kPageBytes);
    if (!page) return page.error();
    if (page->empty()) return {};
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
  }
  return {};
}

/// Removes the assets that no job needs and that nobody has used for `grace`.
core::Status Sweeper::sweep_assets(Duration grace) {
  const uint64_t changes = changes_ + context_.assets->commits();
  if (changes == swept_changes_) return {};
  std::unordered_set<std::string> names;
  for (std::string& name : context_.assets->names()) names.insert(std::move(name));
  uint64_t seen = 0;
  if (core::Status spared = spare_needed(names, seen); !spared) return spared;
  unclaimed_.keep_only(names);
  bool all = true;
  while (!names.empty() && !context_.stop) {
    {
      // No submission comes between the last look and the removal: it finds its files here, or not.
      const std::lock_guard one(context_.submissions);
      if (core::Status spared = spare_needed(names, seen); !spared) return spared;
      for (size_t i = 0; i < kNamesAtOnce && !names.empty(); ++i) {
        const auto name = names.begin();
        const bool gone = context_.options.leads() && context_.assets->remove_unused(*name, grace);
        if (gone) unclaimed_.remove(*name);
        all = all && gone;
        names.erase(name);
      }
    }
    std::this_thread::sleep_for(kOthersTurn);
  }
  if (all && !context_.stop) swept_changes_ = changes;
  return {};
}

Sweeper::Sweeper(ControllerContext& context, UnclaimedFiles& unclaimed)
    : context_(context),
      unclaimed_(unclaimed),
      rounds_(1, std::clamp(context.options.asset_grace / 4, kShortestRound, kLongestRound)),
      leftovers_(2, kPieceEvery) {}

void Sweeper::start() {
  drop_rows();  // of jobs that were removed before a crash
  rounds_.add(0, [this] {
    if (!folders_swept_) folders_swept_ = sweep_folders();
    // What fails now (a full disk, a damaged record) is tried again; nothing was removed wrongly.
    if (!context_.stop) (void)sweep_assets(context_.options.asset_grace);
    return context_.stop.load();
  });
}

}  // namespace hyades::coordinator
