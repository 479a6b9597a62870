#include "coordinator/controller/job_table.h"

#include <atomic>
#include <chrono>
#include <utility>

#include "core/base/wall_clock.h"
#include "farm/log.h"
#include "farm/wire.h"

namespace hyades::coordinator {

ActiveJob* JobTable::find(JobId job) {
  const auto found = jobs_.find(job);
  return found == jobs_.end() ? nullptr : found->second.get();
}

void JobTable::add(std::unique_ptr<ActiveJob> job) {
  const JobId id = job->id;
  jobs_.emplace(id, std::move(job));
}

std::unique_ptr<ActiveJob> JobTable::take_out(uint64_t job) {
  leaving_.insert(job);
  return std::move(jobs_.extract(JobId{job}).mapped());
}

void JobTable::left(uint64_t job) {
  {
    const StateLock lock(mutex_);
    leaving_.erase(job);
  }
  left_.notify_all();
}

bool JobTable::wait_until_left(uint64_t job, TimePoint time, const std::atomic<bool>& stop) {
  StateLock lock(mutex_);
  for (;;) {
    if (stop) return false;
    const ActiveJob* active = find(job);
    if ((active == nullptr || !active->ending) && !leaving_.contains(job)) return true;
    if (std::chrono::steady_clock::now() >= time) return false;
    lock.wait_until(left_, time);
  }
}

void JobTable::clear() {
  Jobs jobs;
  const StateLock lock(mutex_);
  jobs = std::exchange(jobs_, {});
}

void JobTable::wait_for_recovery(StoredJob job) {
  const uint64_t id = job.id;
  waiting_[id] = std::move(job);
}

void JobTable::still_waits(uint64_t job, const std::string& reason) {
  const auto waiting = waiting_.find(job);
  if (waiting != waiting_.end()) waiting->second.reason = reason;
}

std::unique_ptr<JobTable::Recovery> JobTable::begin_recovery(uint64_t job, Recovering what) {
  if (!recovering_.try_emplace(job, std::move(what)).second) return nullptr;
  return std::make_unique<Recovery>(*this, job);
}

JobTable::Recovery::~Recovery() {
  const StateLock lock(table_.mutex_);
  table_.recovering_.erase(job_);
}

void JobTable::note(ActiveJob& job, v1::LogLevel level, std::optional<int32_t> frame,
                    const std::string& worker, const std::string& text, const core::Unit* unit) {
  job.note({core::wall_ms(), level, frame, worker, farm::wire_text(text)});
  // Of frames there are many: that they begin and end is for those who look for something.
  const farm::LogLevel said = level == v1::LOG_LEVEL_ERROR     ? farm::LogLevel::error
                              : level == v1::LOG_LEVEL_WARNING ? farm::LogLevel::warning
                              : frame                          ? farm::LogLevel::debug
                                                               : farm::LogLevel::info;
  if (!farm::logs(said)) return;
  farm::log_later(said, farm::wire_text(text),
                  {static_cast<uint64_t>(job.id), frame,
                   unit == nullptr ? std::string() : farm::unit_field(*unit), worker});
}

}  // namespace hyades::coordinator
