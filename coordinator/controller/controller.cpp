#include "coordinator/controller/controller.h"

#include <atomic>
#include <chrono>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/action_executor.h"
#include "coordinator/controller/divergent_workers.h"
#include "coordinator/controller/farm_id.h"
#include "coordinator/controller/frame_finisher.h"
#include "coordinator/controller/frame_progress.h"
#include "coordinator/controller/job_films.h"
#include "coordinator/controller/job_records.h"
#include "coordinator/controller/job_recovery.h"
#include "coordinator/controller/job_starter.h"
#include "coordinator/controller/sweeper.h"
#include "coordinator/film_store/disk_film_logs.h"
#include "coordinator/meters/meters.h"

namespace hyades::coordinator {
namespace {

constexpr Duration kClock = std::chrono::milliseconds(50);
constexpr Duration kPokeEvery = std::chrono::milliseconds(200);
/// What jobs wait for is looked for among all workers: of the time, one part in so many goes there.
constexpr int kObstaclesShare = 20;

SchedulerOptions scheduler_options(const ControllerOptions& options, uint64_t incarnation) {
  SchedulerOptions scheduler;
  scheduler.incarnation = incarnation;
  scheduler.unit_time = options.unit_time;
  scheduler.lease_time = options.lease_time;
  scheduler.copy_after = options.copy_after;
  scheduler.class_patience = options.class_patience;
  scheduler.film_memory = options.film_memory;
  return scheduler;
}

/// Makes the folders with their parts, and empties the one for what is temporary.
core::Status make_folders(const ControllerOptions& options) {
  std::error_code failed;
  const std::string temporary = options.folder + "/tmp";
  for (const std::string& folder : {options.folder, temporary, options.files + "/outputs"}) {
    std::filesystem::create_directories(folder, failed);
    if (failed) return core::Error{folder + ": " + failed.message()};
  }
  for (const auto& left : std::filesystem::directory_iterator(temporary, failed)) {
    std::filesystem::remove_all(left.path(), failed);
  }
  return {};
}

}  // namespace

/// The parts, each after those that it needs.
struct Controller::Parts {
  Parts(const ControllerOptions& options, std::unique_ptr<JobStore> store,
        std::unique_ptr<FilmLogs> films, std::unique_ptr<farm::ContentStore> assets,
        uint64_t incarnation, std::string secret)
      : context(options, std::move(store), std::move(films), std::move(assets), incarnation,
                std::move(secret)),
        quotas(context.options.per_owner),
        dispatcher(context.mutex, scheduler_options(options, incarnation)) {
    dispatcher.set_action_handler(executor);
  }

  void tick() HYADES_EXCLUDES(state_lock);

  ControllerContext context;
  OwnerQuotas quotas;
  UnclaimedFiles unclaimed;
  OwnerConnections connections{quotas};
  Timelines timelines;
  Dispatcher dispatcher;
  JobTable jobs{context.mutex};
  WorkerTable workers{context, jobs};
  Watchers watchers{context, jobs};
  DiskWatch disk{context, dispatcher, jobs};
  WorkerSessions sessions{context, dispatcher, jobs, workers, disk};
  DivergentWorkers divergent{context, dispatcher, jobs, workers};
  JobQueries queries{context, dispatcher, jobs, disk, timelines};
  JobRecords records{context, jobs, queries, watchers};
  FarmControl farm{context, dispatcher, jobs, workers, records, disk};
  JobFilms films{context, dispatcher, jobs, divergent};
  FrameFinisher finisher{context, dispatcher, jobs, disk, timelines};
  FrameProgress frames{context, dispatcher, jobs, workers, finisher, timelines};
  VideoMaker videos{context, jobs, records, disk, timelines};
  JobStarter starter{context, dispatcher, jobs, films};
  JobRecovery recovery{context, jobs, starter};
  Sweeper sweeper{context, unclaimed};
  JobIntake intake{context, dispatcher, jobs,      queries, records, starter,  recovery,
                   disk,    sweeper,    timelines, videos,  quotas,  unclaimed};
  JobSteering steering{context, dispatcher, jobs, queries, records, finisher, videos};
  Diagnosis diagnosis{context, dispatcher, jobs, workers, sessions, disk, videos};
  ActionExecutor executor{context, jobs,      workers, sessions, films,
                          frames,  divergent, records, videos};
  std::atomic<TimePoint> last_turn{std::chrono::steady_clock::now()};
  TimePoint last_poke;   ///< of the clock
  TimePoint look_again;  ///< of the clock, for obstacles
  farm::RetryQueue clock{1, kClock};
};

core::Result<std::unique_ptr<Controller>> Controller::open(const ControllerOptions& wanted,
                                                           std::unique_ptr<JobStore> store,
                                                           std::unique_ptr<FilmLogs> films) {
  ControllerOptions options = wanted;
  if (options.files.empty()) options.files = options.folder;
  if (auto made = make_folders(options); !made) return made.error();
  bool was_ours = false;
  if (!store) {
    const std::string state = options.folder + "/state.db";
    was_ours = std::filesystem::exists(state);
    if (!was_ours && std::filesystem::exists(state + ".migrated")) {
      return core::Error{options.folder +
                         ": its farm was moved into a database (state.db.migrated): expected "
                         "--state, as 'hyades migrate' was given it"};
    }
    auto opened = open_sqlite_job_store(state);
    if (!opened) return opened.error();
    store = std::move(*opened);
  }
  if (!films) films = disk_film_logs(options.folder + "/films");
  auto secret = store->secret();
  if (!secret) return secret.error();
  if (auto ours = claim_files(options.files, *secret, was_ours); !ours) return ours.error();
  auto assets = farm::ContentStore::open({options.files + "/assets", 0});
  if (!assets) return assets.error();
  const auto incarnation = store->next_incarnation();
  if (!incarnation) return incarnation.error();
  std::unique_ptr<Controller> controller(new Controller(
      std::make_unique<Parts>(options, std::move(store), std::move(films), std::move(*assets),
                              *incarnation, std::move(*secret))));
  Parts& parts = *controller->parts_;
  if (auto loaded = parts.workers.load(); !loaded) return loaded.error();
  if (auto loaded = parts.divergent.load(); !loaded) return loaded.error();
  {
    const StateLock lock(parts.context.mutex);
    parts.jobs.begin_moments(*incarnation << 32U);
  }
  if (auto recovered = parts.recovery.recover_all(); !recovered) return recovered.error();
  {
    const StateLock lock(parts.context.mutex);
    // From here on workers can come: to recover many jobs may take longer than they are given.
    // Where no job is open nobody holds anything.
    const bool any = !parts.jobs.all().empty() || !parts.jobs.waiting().empty();
    if (*incarnation > 1 && any) parts.sessions.begin_adoption();
  }
  parts.clock.add(0, [&parts] {
    if (!parts.context.stop) parts.tick();
    return parts.context.stop.load();
  });
  parts.sweeper.start();
  parts.disk.start();
  return controller;
}

Controller::Controller(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

/// What goes on beside the calls of workers and clients.
void Controller::Parts::tick() {
  const TimePoint now = std::chrono::steady_clock::now();
  last_turn = now;
  records.answer_late(now);
  Turn turn(dispatcher);
  if (const auto wake = dispatcher.scheduler().next_wake(); wake && *wake <= now) {
    turn.tell(Tick{});
  }
  sessions.look_after(turn);
  if (now - last_poke < kPokeEvery) return;
  last_poke = now;
  workers.note_speeds(now, dispatcher.scheduler());
  records.look_after(now, disk.is_full(), dispatcher.scheduler());
  if (now >= look_again) {
    const auto begun = std::chrono::steady_clock::now();
    diagnosis.note_obstacles();
    look_again = now + kObstaclesShare * (std::chrono::steady_clock::now() - begun);
  }
  watchers.poke_changed();
}

void Controller::stop() {
  parts_->context.stop = true;
  parts_->records.answer_late({});
  parts_->jobs.wake();
  parts_->finisher.stop();
  parts_->videos.stop();
  parts_->sessions.close({grpc::StatusCode::UNAVAILABLE, "the coordinator stops"});
}

Controller::~Controller() {
  stop();
  const TimePoint stopped = std::chrono::steady_clock::now();
  parts_->clock.end();
  parts_->recovery.end();
  parts_->finisher.end();
  parts_->videos.end();
  parts_->sweeper.end();
  parts_->disk.end();
  // Others leave it some tasks.
  parts_->context.background.end();
  parts_->records.store_accounts(stopped);
  parts_->context.closing.end();
  parts_->jobs.clear();
}

WorkerSessions& Controller::workers() { return parts_->sessions; }
FarmControl& Controller::farm() { return parts_->farm; }
JobIntake& Controller::jobs() { return parts_->intake; }
JobSteering& Controller::steering() { return parts_->steering; }
JobQueries& Controller::queries() { return parts_->queries; }
Diagnosis& Controller::diagnosis() { return parts_->diagnosis; }
VideoMaker& Controller::videos() { return parts_->videos; }
Watchers& Controller::watchers() { return parts_->watchers; }
DiskWatch& Controller::disk() { return parts_->disk; }

const OwnerQuotas& Controller::quotas() const { return parts_->quotas; }
UnclaimedFiles& Controller::unclaimed() { return parts_->unclaimed; }
OwnerConnections& Controller::connections() { return parts_->connections; }

TimePoint Controller::last_turn() const { return parts_->last_turn; }

Meters& Controller::meters() { return *parts_->context.meters; }
farm::ContentStore& Controller::assets() { return *parts_->context.assets; }
JobStore& Controller::store() { return *parts_->context.store; }

std::string Controller::output_folder(uint64_t job) const {
  return parts_->context.output_folder(job);
}

}  // namespace hyades::coordinator
