#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <utility>

#include "coordinator/film_store/film_store.h"

namespace hyades::coordinator {
namespace {

using Clock = std::chrono::steady_clock;

/// After a compaction has failed.
constexpr Duration kCompactAgain = std::chrono::seconds(5);

}  // namespace

/// Rewrites the log when films of finished frames, and units that could lie in it merged, fill it;
/// where room is wanted, as soon as there is anything to gain.
void FilmStore::compact_if_worthwhile(bool room_wanted) {
  if (!log_ || settled_sequence_ == 0 || Clock::now() < compact_again_) return;
  // What nobody asks for now goes only when the log has grown.
  const bool gain = !others_films_ && (useless_bytes_ > 0 || log_bytes_ > snapshot_bytes_);
  if (!(room_wanted && gain) &&
      log_bytes_ < std::max(options_.compact_bytes, 2 * snapshot_bytes_)) {
    return;
  }
  for (const auto* films : {&films_, &unfinished_}) {
    for (const auto& [frame, film] : *films) {
      if (film && may_be_too_large(*film)) return;
    }
  }
  for (const auto& [frame, put] : aside_.frames()) {
    if (put.too_large) return;
  }
  const uint64_t snapshot_before = std::exchange(snapshot_bytes_, 0);
  std::map<int32_t, uint64_t> frames_before = std::exchange(frame_bytes_, {});
  Places places;
  const core::Status done = log_->compact(
      settled_sequence_,
      [&](const FilmLog::Sink& sink) {
        own_thread_.assert_held();
        return write_snapshot(sink, places);
      },
      [&] {
        own_thread_.assert_held();
        for (auto& [frame, records] : places) aside_.move(frame, std::move(records));
      });
  if (done) {
    log_bytes_ = useless_bytes_ = 0;
    others_films_ = false;
    return;
  }
  // The log is as good as before, only longer.
  snapshot_bytes_ = snapshot_before;
  frame_bytes_ = std::move(frames_before);
  compact_again_ = Clock::now() + kCompactAgain;
  const core::MutexLock lock(mutex_);
  if (draining_) return;
  if (trouble_.empty()) trouble_since_ = Clock::now();
  trouble_ = done.error().message;
}

core::Status FilmStore::write_snapshot(const FilmLog::Sink& sink, Places& places) {
  const auto put = [&](std::span<const std::byte> bytes) {
    own_thread_.assert_held();
    snapshot_bytes_ += bytes.size();
    return sink(bytes);
  };
  const CutRecord cut{set_.region, tile_size_, set_.samples};
  core::Status status = put(encode_cut(cut));
  if (status && disputed_) status = put(encode(DisputeRecord{.open = true}));
  for (const auto& [frame, finished] : finished_) {
    if (status) status = put(encode_finished(frame, finished));
  }
  std::map<int32_t, std::shared_ptr<core::Film>> films = films_;
  films.insert(unfinished_.begin(), unfinished_.end());
  for (const auto& [frame, film] : films) {
    if (status && film) status = put_film(frame, *film, put);
  }
  for (const auto& [frame, known] : aside_.frames()) {
    if (status) status = copy_aside(frame, put, places);
  }
  return status;
}

/// Copies the records of a film that is set aside, so that it does not come into memory.
core::Status FilmStore::copy_aside(int32_t frame, const FilmLog::Sink& sink, Places& places) {
  const auto alone = hold_whole_records();
  const bool in_log = !aside_.frames().at(frame).places.empty();
  return aside_.copy(frame, [&](std::span<const std::byte> record) -> core::Status {
    own_thread_.assert_held();
    if (core::Status done = count(frame, record, sink); !done) return done;
    if (in_log) places[frame].push_back(log_->place());
    return {};
  });
}

core::Status FilmStore::put_film(int32_t frame, const core::Film& film, const FilmLog::Sink& sink) {
  const auto alone = hold_whole_records();
  return write_film(frame, key_of(frame), film, {set_.region, tile_size_, set_.samples},
                    class_of(frame), [&](std::span<const std::byte> record) {
                      own_thread_.assert_held();
                      return count(frame, record, sink);
                    });
}

/// Puts a record of the frame into a snapshot, which ends when the run does.
core::Status FilmStore::count(int32_t frame, std::span<const std::byte> record,
                              const FilmLog::Sink& sink) {
  frame_bytes_[frame] += record.size();
  if (core::Status done = sink(record); !done) return done;
  const core::MutexLock lock(mutex_);
  if (draining_) return core::Error{"the run ends"};
  return {};
}

}  // namespace hyades::coordinator
