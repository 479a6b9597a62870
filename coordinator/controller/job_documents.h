#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <grpcpp/support/status.h>

#include "coordinator/controller/state_lock.h"
#include "coordinator/scheduler/ids.h"
#include "core/base/mutex.h"
#include "core/base/result.h"
#include "farm/content_store.h"
#include "farm/fair_shares.h"
#include "farm/job_package.h"
#include "hyades/v1/jobs.pb.h"

namespace hyades::coordinator {

class JobDocuments;

/// For the documents of others to be read, where one may come again: longer than any takes.
inline constexpr std::chrono::seconds kReadingPatience{15};
/// What a client is told whose document could not be read within that: to come again.
grpc::Status others_are_read();

/// A job's document in the hands of who needs it now, and lets it go soon: where it is too long to
/// be kept, no other is read as long as somebody holds it. JobDocuments has to outlive it.
class JobDocument {
 public:
  const farm::ReadJob* operator->() const { return read_.get(); }
  const farm::ReadJob& operator*() const { return *read_; }

 private:
  friend class JobDocuments;

  /// Lets the next document be read, once the memory of this one is free.
  struct EndReading {
    std::chrono::steady_clock::time_point begun;
    void operator()(JobDocuments* documents) const;
  };
  using Reading = std::unique_ptr<JobDocuments, EndReading>;

  JobDocument(std::shared_ptr<const farm::ReadJob> read, Reading reading)
      : reading_(std::move(reading)), read_(std::move(read)) {}

  Reading reading_;  ///< of one that is too long to be kept; ends after `read_`
  std::shared_ptr<const farm::ReadJob> read_;
};

/// What documents of jobs say, read out of their files. Those that were used last stay in memory as
/// far as they fit, whichever jobs they are of; others are read again, one at a time, as a long one
/// takes seconds and some hundred megabytes: next for whom lately least time was spent on reading.
/// So open jobs can have any number of long documents. Thread-safe.
class JobDocuments {
 public:
  /// `most_bytes`: of those that stay in memory.
  JobDocuments(farm::ContentStore& assets, uint64_t most_bytes)
      : assets_(assets), most_bytes_(most_bytes) {}

  /// Nothing where others were still being read after `patience`, or at once where another of the
  /// owner's is read or waits already. Errors hold every complaint about the document, or say which
  /// of its files is gone.
  using Found = std::optional<core::Result<JobDocument>>;
  /// The job as the spec's document and samples say it. May wait for the disk. `owner`: for whom;
  /// empty: nobody in particular, of whom any number wait.
  Found read(const v1::JobSpec& spec, std::chrono::milliseconds patience,
             const std::string& owner = {}) HYADES_EXCLUDES(state_lock, mutex_);
  /// What read() finds for a spec as it is stored (StoredJob::spec); an error where that is
  /// damaged.
  Found read_stored(const std::string& spec, std::chrono::milliseconds patience,
                    const std::string& owner = {}) HYADES_EXCLUDES(state_lock, mutex_);

  /// Bytes of those that stay in memory.
  uint64_t kept_bytes() const HYADES_EXCLUDES(mutex_);
  /// How often one was read.
  uint64_t times_read() const HYADES_EXCLUDES(mutex_);

 private:
  friend struct JobDocument::EndReading;
  using Time = std::chrono::steady_clock::time_point;
  using Document = std::shared_ptr<const farm::ReadJob>;
  struct Kept {
    Digest name{};
    Document document;
    uint64_t bytes = 0;
  };

  Document find(const Digest& name) HYADES_EXCLUDES(mutex_);
  bool keep(Kept fresh) HYADES_EXCLUDES(mutex_);
  bool begin_reading(Time give_up, const std::string& owner) HYADES_EXCLUDES(mutex_);
  void end_reading(Time begun) HYADES_EXCLUDES(mutex_);
  uint64_t next_reader(Time now) const HYADES_REQUIRES(mutex_);

  farm::ContentStore& assets_;
  const uint64_t most_bytes_;
  mutable core::Mutex mutex_;
  core::CondVar reading_ended_;
  std::list<Kept> kept_ HYADES_GUARDED_BY(mutex_);  ///< those that were used last are first
  std::map<Digest, std::list<Kept>::iterator> places_ HYADES_GUARDED_BY(mutex_);
  uint64_t kept_bytes_ HYADES_GUARDED_BY(mutex_) = 0;
  uint64_t times_read_ HYADES_GUARDED_BY(mutex_) = 0;
  bool reading_ HYADES_GUARDED_BY(mutex_) = false;
  std::string reads_for_ HYADES_GUARDED_BY(mutex_);  ///< the owner that a document is read for
  struct Waiting {
    uint64_t number = 0;
    std::string owner;
  };
  /// Those who wait to read one, in the order in which they came.
  std::deque<Waiting> waiting_ HYADES_GUARDED_BY(mutex_);
  farm::FairShares shares_ HYADES_GUARDED_BY(mutex_);  ///< seconds of reading, of owners
  uint64_t next_waiting_ HYADES_GUARDED_BY(mutex_) = 0;
};

}  // namespace hyades::coordinator
