#include "coordinator/controller/job_documents.h"

#include <malloc.h>

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "coordinator/controller/active_job.h"
#include "core/base/hash.h"
#include "core/job/job_memory.h"
#include "farm/manifest_resolver.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

constexpr uint32_t kMostSamples = 1U << 24U;
/// Who took longer took much memory, and the allocator would keep it: about five megabytes.
constexpr std::chrono::milliseconds kLong{100};

/// What names the document of a spec, whichever its frames.
Digest name_of(const v1::JobSpec& spec) {
  v1::JobSpec named;
  named.set_document(spec.document());
  named.set_samples(spec.samples());
  *named.mutable_files() = spec.files();
  return core::sha256(named.SerializeAsString());
}

core::Result<farm::ReadJob> read_now(const v1::JobSpec& spec, farm::ContentStore& assets) {
  const auto records = files_of(spec);
  if (!records) return records.error();
  if (spec.samples() > kMostSamples) {
    return core::Error{fmt::format("{} samples: at most {}", spec.samples(), kMostSamples)};
  }
  farm::ManifestResolver files(*records, assets);
  auto read = farm::read_job(spec.document(), spec.document(), files);
  if (read && spec.samples() > 0) read->job.sampling.samples = spec.samples();
  return read;
}

uint64_t memory_of(const farm::ReadJob& read) {
  constexpr uint64_t kRecord = sizeof(core::AssetRecord) + 2 * 64;  // its hash, and what blocks add
  uint64_t bytes = core::memory_of(read.job);
  for (const core::AssetRecord& record : read.assets) bytes += kRecord + record.reference.size();
  return bytes;
}

}  // namespace

grpc::Status others_are_read() {
  return farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED,
                           "the documents of other jobs are being read, or another of yours",
                           std::chrono::seconds(1));
}

void JobDocument::EndReading::operator()(JobDocuments* documents) const {
  if (std::chrono::steady_clock::now() - begun > kLong) ::malloc_trim(0);
  documents->end_reading(begun);
}

JobDocuments::Found JobDocuments::read(const v1::JobSpec& spec, std::chrono::milliseconds patience,
                                       const std::string& owner) {
  const Digest name = name_of(spec);
  if (Document kept = find(name)) return JobDocument(std::move(kept), nullptr);
  if (!begin_reading(std::chrono::steady_clock::now() + patience, owner)) return std::nullopt;
  JobDocument::Reading reading(this, {std::chrono::steady_clock::now()});
  // Somebody may have read it meanwhile.
  if (Document kept = find(name)) return JobDocument(std::move(kept), nullptr);
  auto found = read_now(spec, assets_);
  {
    const core::MutexLock lock(mutex_);
    ++times_read_;
  }
  if (!found) return found.error();
  const uint64_t bytes = memory_of(*found);
  auto document = std::make_shared<const farm::ReadJob>(std::move(*found));
  if (keep({name, document, bytes})) reading.reset();
  return JobDocument(std::move(document), std::move(reading));
}

JobDocuments::Found JobDocuments::read_stored(const std::string& spec,
                                              std::chrono::milliseconds patience,
                                              const std::string& owner) {
  v1::JobSpec parsed;
  if (!parsed.ParseFromString(spec)) return core::Error{"the job's record is damaged"};
  return read(parsed, patience, owner);
}

JobDocuments::Document JobDocuments::find(const Digest& name) {
  const core::MutexLock lock(mutex_);
  const auto place = places_.find(name);
  if (place == places_.end()) return nullptr;
  kept_.splice(kept_.begin(), kept_, place->second);
  return place->second->document;
}

/// False where it is too long.
bool JobDocuments::keep(Kept fresh) {
  if (fresh.bytes > most_bytes_) return false;
  std::list<Kept> dropped;  // what takes its time is done without the lock
  const core::MutexLock lock(mutex_);
  kept_bytes_ += fresh.bytes;
  kept_.push_front(std::move(fresh));
  places_[kept_.front().name] = kept_.begin();
  while (kept_bytes_ > most_bytes_) {
    kept_bytes_ -= kept_.back().bytes;
    places_.erase(kept_.back().name);
    dropped.splice(dropped.end(), kept_, std::prev(kept_.end()));
  }
  return true;
}

bool JobDocuments::begin_reading(Time give_up, const std::string& owner) {
  const core::MutexLock lock(mutex_);
  const auto is_his = [&](const Waiting& other) { return other.owner == owner; };
  const bool reads_his = reading_ && reads_for_ == owner;
  if (!owner.empty() && (reads_his || std::any_of(waiting_.begin(), waiting_.end(), is_his))) {
    return false;
  }
  const uint64_t number = next_waiting_++;
  waiting_.push_back({number, owner});
  const auto leave = [&]() HYADES_REQUIRES(mutex_) {
    std::erase_if(waiting_, [&](const Waiting& other) { return other.number == number; });
  };
  for (;;) {
    const Time now = std::chrono::steady_clock::now();
    if (!reading_ && next_reader(now) == number) break;
    if (now >= give_up) {
      leave();
      reading_ended_.notify_all();
      return false;
    }
    reading_ended_.wait_until(mutex_, give_up);
  }
  leave();
  reading_ = true;
  reads_for_ = owner;
  return true;
}

/// Of those who wait, the first for whose owner least was read lately.
uint64_t JobDocuments::next_reader(Time now) const {
  const auto next = shares_.next(waiting_.begin(), waiting_.end(), now,
                                 [](const Waiting& one) { return &one.owner; });
  return next->number;
}

void JobDocuments::end_reading(Time begun) {
  const core::MutexLock lock(mutex_);
  const Time now = std::chrono::steady_clock::now();
  shares_.use(reads_for_, std::chrono::duration<double>(now - begun).count(), now);
  reading_ = false;
  reading_ended_.notify_all();
}

uint64_t JobDocuments::kept_bytes() const {
  const core::MutexLock lock(mutex_);
  return kept_bytes_;
}

uint64_t JobDocuments::times_read() const {
  const core::MutexLock lock(mutex_);
  return times_read_;
}

}  // namespace hyades::coordinator
