// Opening the folder, and the end.
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/controller.h"
#include "coordinator/meters/meters.h"

namespace hyades::coordinator {
namespace {

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

}  // namespace

core::Result<std::unique_ptr<Controller>> Controller::open(const ControllerOptions& options,
                                                           std::unique_ptr<JobStore> store) {
  std::error_code failed;
  for (const char* part : {"", "/films", "/outputs", "/tmp"}) {
    std::filesystem::create_directories(options.folder + part, failed);
    if (failed) return core::Error{options.folder + part + ": " + failed.message()};
  }
  for (const auto& left : std::filesystem::directory_iterator(options.folder + "/tmp", failed)) {
    std::filesystem::remove_all(left.path(), failed);
  }
  if (!store) {
    auto opened = open_sqlite_job_store(options.folder + "/state.db");
    if (!opened) return opened.error();
    store = std::move(*opened);
  }
  auto assets = farm::ContentStore::open({options.folder + "/assets", 0});
  if (!assets) return assets.error();
  const auto incarnation = store->next_incarnation();
  if (!incarnation) return incarnation.error();
  std::unique_ptr<Controller> controller(
      new Controller(options, std::move(store), std::move(*assets), *incarnation));
  const auto quarantines = controller->store_->quarantines();
  if (!quarantines) return quarantines.error();
  for (const StoredQuarantine& kept : *quarantines) {
    controller->quarantines_[kept.worker] = kept.reason;
  }
  const auto trusted = controller->store_->trusted();
  if (!trusted) return trusted.error();
  for (const StoredTrust& kept : *trusted) controller->trust_[kept.worker] = {kept.moment};
  if (auto taken = controller->recover_jobs(); !taken) return taken.error();
  // From here on workers can come: to take up many jobs may take longer than they are given.
  // Where no job is open nobody holds anything.
  if (*incarnation > 1 && !controller->jobs_.empty()) {
    const TimePoint now = std::chrono::steady_clock::now();
    controller->adopting_until_ = now + options.adoption_time;
    controller->adopting_at_most_ = now + 4 * options.adoption_time;
  }
  Controller& b = *controller;
  b.threads_.emplace_back([&b] { b.clock_loop(); });
  b.threads_.emplace_back([&b] { b.finish_loop(); });
  b.threads_.emplace_back([&b] { b.video_loop(); });
  b.threads_.emplace_back([&b] { b.sweep_loop(); });
  b.threads_.emplace_back([&b] { b.disk_loop(); });
  return controller;
}

Controller::Controller(ControllerOptions options, std::unique_ptr<JobStore> store,
                       std::unique_ptr<farm::ContentStore> assets, uint64_t incarnation)
    : options_(std::move(options)),
      store_(std::move(store)),
      assets_(std::move(assets)),
      incarnation_(incarnation),
      started_ms_(wall_ms()),
      meters_(std::make_unique<Meters>()),
      scheduler_(scheduler_options(options_, incarnation)),
      moment_(incarnation << 32U),
      disk_(options_.disk) {}

void Controller::stop() {
  stop_ = true;
  mind_waiters({});
  const std::lock_guard lock(mutex_);
  clock_wake_.notify_all();
  away_wake_.notify_all();
  finish_wake_.notify_all();
  video_stop_ = true;
  video_wake_.notify_all();
  sweep_wake_.notify_all();
  disk_wake_.notify_all();
  for (auto& [id, session] : sessions_) {
    if (session.link) session.link->close({grpc::StatusCode::UNAVAILABLE, "the coordinator stops"});
  }
}

Controller::~Controller() {
  stop();
  for (std::thread& thread : threads_) thread.join();
  // The tasks go last: others leave them some.
  background_.end();
  std::map<JobId, std::unique_ptr<ActiveJob>> jobs;
  {
    const std::lock_guard lock(mutex_);
    jobs = std::exchange(jobs_, {});
  }
}

std::string Controller::output_folder(uint64_t job) const {
  return fmt::format("{}/outputs/{}", options_.folder, job);
}

std::string Controller::films_folder(uint64_t job) const {
  return fmt::format("{}/films/{}", options_.folder, job);
}

}  // namespace hyades::coordinator
