#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

#include "coordinator/film_store/disk_room.h"
#include "coordinator/film_store/film_store.h"
#include "coordinator/scheduler/ids.h"
#include "core/base/machine.h"

namespace hyades::coordinator {

/// What rendering costs.
struct Price {
  double per_core_hour = 0;  ///< of one thread; 0: nobody has said
  std::string currency;      ///< three capital letters (ISO 4217), or empty
};

/// What one owner may have of the farm at a time, so that nobody takes all of it; 0: as much as he
/// likes.
struct OwnerLimits {
  uint64_t bytes = 0;        ///< of unfinished uploads, and of files that no job has had
  uint64_t files = 1000;     ///< unfinished uploads
  uint64_t jobs = 0;         ///< that are not over
  double core_hours = 0;     ///< within kCoreHoursWindow, beyond which no job is taken in
  uint64_t connections = 0;  ///< open streams with tokens of one name
};

/// What open jobs have of the coordinator's memory, but for their films.
struct JobRoom {
  uint64_t frames = 0;
  uint64_t bytes = 0;  ///< ActiveJob::bytes: mostly what their submissions name
};

/// How a controller works, and where.
struct ControllerOptions {
  std::string folder;  ///< where all state lies; made if it is missing
  /// Where assets and outputs lie, which coordinators that take over from each other share; empty:
  /// `folder`.
  std::string files;
  /// Whether this process may still remove what others may need by now; of coordinators that take
  /// over from each other one may (LeaderLease::holds).
  std::function<bool()> leads = [] { return true; };
  std::string finisher;                          ///< the program hyades-film
  Duration unit_time = std::chrono::seconds(5);  ///< that one thread is to take for one unit
  /// A lease that is not renewed for this long is lost.
  Duration lease_time = std::chrono::seconds(30);
  Duration copy_after = std::chrono::seconds(10);  ///< SchedulerOptions::copy_after
  /// A frame whose class of workers has been gone for this long begins again with another.
  Duration class_patience = std::chrono::minutes(5);
  /// A worker whose stream has ended is lost if it has not come again after this.
  Duration reconnect_time = std::chrono::seconds(3);
  /// A worker whose stream has ended is forgotten if it has not come again after this.
  Duration forget_time = std::chrono::hours(1);
  DiskLimits disk;  ///< how much of the disk the folder may take
  /// Files that no job needs any more stay for so long after they were last used.
  Duration asset_grace = std::chrono::hours(1);
  /// After a restart no new units are leased for this long, so that workers can say what they hold;
  /// longer, up to four times this, while those who hold something still come. By default the
  /// longest wait of a worker (farm/backoff.h), and what connecting takes.
  Duration adoption_time = std::chrono::seconds(5);
  /// A lease whose rendering makes no progress is not renewed any more after this; where the worker
  /// loads or waits, after six times this.
  Duration stall_time = std::chrono::minutes(10);
  /// For so long a start recovers open jobs before anybody is answered; the rest come afterwards.
  Duration recovery_time = std::chrono::seconds(15);
  /// Bytes that films of frames in work, of all jobs, may take in memory. Jobs of which one frame
  /// takes more are refused.
  /// A third: beside films in work, those that are being finished are in memory once more.
  uint64_t film_memory = core::half_of_memory() / 3 * 2;
  /// Bytes that documents of jobs may take in memory beside those that are in use (JobDocuments).
  /// One of 10,000 characters takes some 440 kB, so that those of 1,000 such jobs stay.
  uint64_t document_memory = uint64_t{512} << 20U;
  /// A job's film log is rewritten when it has grown by this much.
  uint64_t compact_bytes = FilmStoreOptions{}.compact_bytes;
  /// What all open jobs together may have; one owner's half of it, so that others get in.
  JobRoom job_room{2'000'000, uint64_t{128} << 20U};
  Price price;
  OwnerLimits per_owner;
};

}  // namespace hyades::coordinator
