#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "coordinator/film_store/film_records.h"
#include "coordinator/film_store/films_aside.h"
#include "coordinator/scheduler/actions.h"
#include "core/film/film.h"
#include "tests/coordinator/film_store/faulty_files.h"

namespace hyades::coordinator {

/// Where a job of a simulated world keeps its films: the real film log with its real records, over
/// a disk in memory that fails, fills, tears and forgets. What cannot be is thrown as a
/// std::string.
class SimulatedDisk {
 public:
  SimulatedDisk(const JobPlan& plan, uint64_t salt) : plan_(plan), salt_(salt) {}

  /// The coordinator starts: what of the job is on the disk.
  LogContents open();
  /// The coordinator dies; with `power` the machine, too: what was not synced may be lost.
  void die(bool power, std::mt19937& random);
  bool is_open() const { return log_ != nullptr; }

  /// Queues the record (of all kinds but FrameFailedRecord) and returns its number. Refused where
  /// too much waits for a disk that is full. `mark`: of the film, see film_of().
  core::Result<uint64_t> append(const Record& record, uint8_t mark);
  /// What waits is written and synced, or kept for another try.
  core::Status commit() { return log_->commit_now(); }
  uint64_t durable() const { return log_->durable(); }

  /// A frame's film, as the coordinator has merged it.
  struct Frame {
    const core::Film* film = nullptr;
    std::string worker_class;
  };
  // Films that are not in memory, as FilmStore keeps them.

  /// Writes the frame's film beside the log.
  core::Status set_aside(int32_t frame, const core::Film& film, const std::string& worker_class);
  bool is_aside(int32_t frame) const { return aside_ && aside_->contains(frame); }
  bool any_aside() const { return aside_ && !aside_->frames().empty(); }
  /// What the film of a frame is that is aside.
  std::string digest_aside(int32_t frame) const;
  /// A tile of a film that is aside becomes void, and the film stays there. What its digest is to
  /// be now; empty where the film is damaged.
  std::string void_aside(const TileVoidedRecord& voided);
  /// The frame's film, which is not there any more.
  core::Result<core::Film> fetch(int32_t frame);
  void forget_aside(int32_t frame) { aside_->remove(frame); }
  /// Some of the file is lost, as a disk may lose it.
  void damage_aside(int32_t frame);

  /// The films, also those that are set aside, and finished frames replace the records up to number
  /// `through`.
  core::Status compact(uint64_t through, const std::vector<int32_t>& finished,
                       const std::map<int32_t, Frame>& frames);

  FaultyFiles& files() { return files_; }
  /// Bytes in all files.
  uint64_t used();

  core::Film blank() const;
  /// What a worker renders of the unit; films with different marks are different.
  core::Film film_of(const core::Unit& unit, uint8_t mark) const;
  /// The whole frame's.
  core::Film oracle(int32_t frame) const;

 private:
  uint32_t samples() const { return plan_.batches * core::kBatchSamples; }

  const JobPlan plan_;
  const uint64_t salt_;
  FaultyFiles files_;
  std::unique_ptr<FilmLog> log_;
  std::unique_ptr<FilmsAside> aside_;
};

}  // namespace hyades::coordinator
