#include "coordinator/controller/job_films.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "coordinator/controller/divergent_workers.h"
#include "coordinator/meters/meters.h"
#include "core/base/overloaded.h"

namespace hyades::coordinator {
namespace {

constexpr size_t kRestartsAtOnce = 1000;
constexpr uint64_t kWaitingBytes = uint64_t{256} << 20U;  ///< of films that wait for the disk

}  // namespace

/// Reports what becomes of one job's films.
class JobFilms::Listener final : public FilmStore::Listener {
 public:
  Listener(JobFilms& films, JobId job) : films_(films), job_(job) {}

  void persisted(RecordId record) override { films_.persisted(job_, record); }
  void not_persisted(RecordId record, const std::string& reason) override {
    films_.not_persisted(job_, record, reason);
  }
  void outgrown(int32_t frame, const std::string& reason) override {
    films_.outgrown(job_, frame, reason);
  }
  void try_again() override {}  // the controller's clock ticks anyway
  void storage_failed(const std::string& reason) override { films_.storage_failed(job_, reason); }
  void drained() override {}

 private:
  JobFilms& films_;
  JobId job_;
};

void JobFilms::persist(const Persist& persist, Delivery* delivery) {
  const RecordId id = persist.id;
  const auto job = std::visit([](const auto& record) { return record.job; }, persist.record);
  ActiveJob* active = jobs_.find(job);
  // That a worker diverges concerns other jobs too.
  const bool of_all_jobs = std::holds_alternative<DivergentWorkerRecord>(persist.record);
  if (active == nullptr && !of_all_jobs) return;
  std::visit(core::Overloaded{
                 [&](const DivergentWorkerRecord& divergent)
                     HYADES_REQUIRES(state_lock) { divergent_.keep(id, divergent); },
                 [&](const UnitRecord& unit) HYADES_REQUIRES(state_lock) {
                   delivery->settled = true;
                   active->films_under_way[id] = std::move(delivery->rendered);
                   of(*active).append(id, unit, std::move(delivery->film),
                                      std::move(delivery->record));
                 },
                 [&](const FrameFailedRecord& failed)
                     HYADES_REQUIRES(state_lock) { fail_frame(*active, id, failed); },
                 [&](const FrameRestartedRecord& again)
                     HYADES_REQUIRES(state_lock) { restart_frame(*active, id, again); },
                 [&](const FrameFinishedRecord& done)
                     HYADES_REQUIRES(state_lock) { of(*active).append(id, done); },
                 [&](const TileVoidedRecord& voided)
                     HYADES_REQUIRES(state_lock) { of(*active).append(id, voided); },
                 [&](const DisputeRecord& dispute)
                     HYADES_REQUIRES(state_lock) { of(*active).append(id, dispute); },
             },
             persist.record);
}

void JobFilms::restart_frame(const ActiveJob& active, RecordId id,
                             const FrameRestartedRecord& again) {
  std::deque<Restart>& waiting = restarts_[again.job];
  waiting.push_back({id, again});
  if (waiting.size() > 1) return;
  context_.in_background(active, [this, job = again.job] { return restart_some(job); });
}

/// Many frames may begin again together: each by itself would wait for the disk.
bool JobFilms::restart_some(JobId job) {
  std::vector<int32_t> frames;
  {
    const StateLock lock(context_.mutex);
    for (const Restart& one : restarts_[job]) {
      if (frames.size() == kRestartsAtOnce) break;
      frames.push_back(one.record.frame);
    }
  }
  const core::Status forgotten = context_.store->forget_frames(static_cast<uint64_t>(job), frames);
  const StateLock lock(context_.mutex);
  ActiveJob* still = jobs_.find(job);
  if (still == nullptr || still->ending) {
    restarts_.erase(job);
    return true;
  }
  if (!forgotten) return false;
  std::deque<Restart>& waiting = restarts_[job];
  for (size_t i = 0; i < frames.size(); ++i) {
    of(*still).append(waiting.front().id, waiting.front().record);
    waiting.pop_front();
  }
  if (waiting.empty()) {
    restarts_.erase(job);
  } else {
    context_.in_background(*still, [this, job] { return restart_some(job); });
  }
  return true;
}

void JobFilms::fail_frame(ActiveJob& active, RecordId id, const FrameFailedRecord& record) {
  const FailedFrame& failed = record.failed;
  const FrameNote& note = active.frames[failed.frame];
  StoredFrame frame{failed.frame, false, failed.reason, note.worker_class, note.restarts};
  context_.in_background(active, [this, id, record, frame] {
    const core::Status stored =
        context_.store->frame_over(static_cast<uint64_t>(record.job), frame, {});
    const StateLock lock(context_.mutex);
    ActiveJob* still = jobs_.find(record.job);
    if (still == nullptr) return true;
    // Where it could not be stored the frame fails again after a restart, if it must.
    if (!stored) still->trouble = stored.error().message;
    of(*still).append(id, record);
    return true;
  });
}

std::unique_ptr<FilmStore> JobFilms::make(ActiveJob& active, bool resume) {
  const uint32_t samples = active.samples;
  FilmSet films{active.numbers, active.region, samples, active.threshold.adaptive(),
                active.layout.layers.splats};
  FilmStoreOptions place;
  place.max_waiting_bytes = kWaitingBytes;
  place.folder = context_.films->folder(active.stored.id);
  place.aside_folder = context_.films->aside_folder(active.stored.id);
  place.files = &context_.films->files();
  place.frame_key = [key = active.key](int32_t) { return key; };
  place.kept = resume ? KeptFilms::require : KeptFilms::erase;
  place.whole_records = &context_.whole_records;
  place.kept_aside = true;
  place.compact_bytes = context_.options.compact_bytes;
  place.on_sync = [meters = context_.meters.get()](std::chrono::nanoseconds took) {
    meters->synced(took);
  };
  if (!active.film_listener) active.film_listener = std::make_unique<Listener>(*this, active.id);
  return std::make_unique<FilmStore>(std::move(films), std::move(place), *active.film_listener);
}

void JobFilms::set_aside(const SetAside& aside, Turn& turn) {
  ActiveJob* active = jobs_.find(aside.job);
  if (active == nullptr) return;
  if (!active->film_store) return turn.tell(FilmSetAside{aside.job, aside.frame, true});
  active->film_store->call([this, aside, film_store = active->film_store.get()] {
    const bool done = film_store->set_aside(aside.frame).ok();
    Turn later(dispatcher_);
    later.tell(FilmSetAside{aside.job, aside.frame, done});
  });
}

/// A job gets its log and threads with its first film, so that those that wait cost little. The
/// store takes what it is given from now on; its log is opened by the job's tasks.
FilmStore& JobFilms::of(ActiveJob& active) {
  if (!active.film_store) {
    active.film_store = make(active, false);
    context_.in_background(active, [this, job = active.id] { return open(job); });
  }
  return *active.film_store;
}

/// The job stays in memory while its tasks do.
bool JobFilms::open(JobId job) {
  FilmStore* film_store = nullptr;
  int32_t tile_size = 0;
  {
    const StateLock lock(context_.mutex);
    ActiveJob* active = jobs_.find(job);
    if (active == nullptr || active->ending) return true;  // or its end would wait for this
    film_store = active->film_store.get();
    tile_size = tile_size_of(*active);
  }
  core::Status opened;
  if (const auto contents = film_store->open(); !contents) opened = contents.error();
  if (opened) opened = film_store->start(tile_size);
  if (!opened) storage_failed(job, opened.error().message);
  return opened.ok();
}

void JobFilms::persisted(JobId job, RecordId record) {
  Turn turn(dispatcher_);
  if (ActiveJob* active = jobs_.find(job); active != nullptr && !active->trouble.empty()) {
    active->trouble.clear();
    active->touch();
  }
  turn.tell(Persisted{record});
}

void JobFilms::not_persisted(JobId job, RecordId record, const std::string& reason) {
  Turn turn(dispatcher_);
  if (ActiveJob* active = jobs_.find(job)) {
    active->films_under_way.erase(record);
    active->trouble = "films cannot be stored: " + reason;
    active->touch();
  }
  turn.tell(PersistFailed{record, reason});
}

void JobFilms::outgrown(JobId job, int32_t frame, const std::string& reason) {
  Turn turn(dispatcher_);
  turn.tell(FrameRefused{job, frame, reason});
}

void JobFilms::storage_failed(JobId job, const std::string& reason) {
  const StateLock lock(context_.mutex);
  if (ActiveJob* active = jobs_.find(job)) {
    active->trouble = "films cannot be stored: " + reason;
    active->touch();
    jobs_.note(*active, v1::LOG_LEVEL_ERROR, std::nullopt, {}, active->trouble);
  }
}

}  // namespace hyades::coordinator
