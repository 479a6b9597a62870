#include "coordinator/web/farm_feed.h"

#include <utility>
#include <vector>

#include "coordinator/brain/all_pages.h"
#include "coordinator/web/farm_api.h"
#include "farm/json_form.h"

namespace hyades::coordinator {
namespace {

constexpr std::chrono::seconds kPerValue{5};
constexpr size_t kMostValues = 720;  // an hour

farm::Json values_of(const std::map<uint64_t, farm::Json>& things) {
  farm::Json all = farm::Json::array();
  for (const auto& [id, thing] : things) all.push_back(thing);
  return all;
}

}  // namespace

void FarmFeed::join(std::weak_ptr<LiveReader> reader) {
  {
    const std::lock_guard lock(mutex_);
    readers_.add(std::move(reader));
  }
  tick();
}

void FarmFeed::tick() {
  if (stepping_.exchange(true)) return;
  const bool taken = desks_.rows.hand([me = shared_from_this()] {
    // Without memory for it nothing is told this time.
    (void)within_memory([&] {
      me->step();
      return grpc::Status::OK;
    });
    me->stepping_ = false;
  });
  if (!taken) stepping_ = false;
}

void FarmFeed::step() {
  const std::vector<v1::Worker> workers = all_workers(brain_);
  note_throughput(workers);
  {
    const std::lock_guard lock(mutex_);
    if (readers_.empty()) {
      // Nobody has to be told what changes meanwhile.
      jobs_.clear();
      workers_.clear();
      info_ = {};
      new_value_.reset();
      return;
    }
  }
  farm::Json change = farm::Json::object();
  v1::InfoResponse asked;
  brain_.info(asked);
  farm::Json info = to_json(asked);
  if (info != info_) change["info"] = info;
  info_ = std::move(info);

  Things workers_now;
  for (const v1::Worker& worker : workers) workers_now[worker.id()] = farm::to_json(worker);
  farm::Json removed = farm::Json::array();
  farm::Json told = changed(workers_now, workers_, removed);
  if (!told.empty()) change["workers"] = std::move(told);
  if (!removed.empty()) change["removed_workers"] = std::move(removed);

  Things jobs_now;
  farm::Json ended = tell_jobs(jobs_now);
  farm::Json gone = farm::Json::array();
  told = changed(jobs_now, jobs_, gone);
  for (farm::Json& job : ended) told.push_back(std::move(job));
  if (!told.empty()) change["jobs"] = std::move(told);
  farm::Json deleted = farm::Json::array();
  for (const farm::Json& id : gone) {
    bool is_told = false;
    if (change.contains("jobs")) {
      for (const farm::Json& job : change["jobs"]) is_told = is_told || job["id"] == id;
    }
    if (!is_told) deleted.push_back(id);
  }
  if (!deleted.empty()) change["removed_jobs"] = std::move(deleted);
  if (new_value_) change["samples_per_second"] = *new_value_;
  new_value_.reset();

  const std::lock_guard lock(mutex_);
  if (!change.empty()) readers_.tell("change", change);
  LiveReaders::Group fresh = readers_.take_fresh();
  if (fresh.empty()) return;
  LiveReaders::tell(fresh, "snapshot",
                    {{"info", info_},
                     {"jobs", values_of(jobs_)},
                     {"workers", values_of(workers_)},
                     {"samples_per_second", throughput_}});
  readers_.know(std::move(fresh));
}

/// The open jobs; and, as JSON, those that were told of as open and have ended.
farm::Json FarmFeed::tell_jobs(Things& jobs) {
  for (const v1::Job& job : all_open_jobs(brain_)) jobs[job.id()] = farm::to_json(job);
  farm::Json ended = farm::Json::array();
  for (const auto& [id, job] : jobs_) {
    if (jobs.contains(id)) continue;
    v1::GetJobResponse got;
    const grpc::Status status = brain_.get(id, INT32_MAX, got);
    if (status.ok()) {
      ended.push_back(farm::to_json(got.job()));
    } else if (status.error_code() != grpc::StatusCode::NOT_FOUND) {
      jobs[id] = job;  // the store does not answer: what became of it is told later
    }
  }
  return ended;
}

/// What is new or different in `now`; `told` is that afterwards.
farm::Json FarmFeed::changed(const Things& now, Things& told, farm::Json& removed) {
  farm::Json different = farm::Json::array();
  for (const auto& [id, thing] : now) {
    const auto old = told.find(id);
    if (old == told.end() || old->second != thing) different.push_back(thing);
  }
  for (const auto& [id, thing] : told) {
    if (!now.contains(id)) removed.push_back(id);
  }
  told = now;
  return different;
}

void FarmFeed::note_throughput(const std::vector<v1::Worker>& workers) {
  for (const v1::Worker& worker : workers) {
    const auto [known, first] = samples_.try_emplace(worker.id(), worker.samples_done());
    if (!first && worker.samples_done() > known->second) {
      new_samples_ += worker.samples_done() - known->second;
    }
    known->second = worker.samples_done();
  }
  const auto now = std::chrono::steady_clock::now();
  if (value_since_.time_since_epoch().count() == 0) value_since_ = now;
  if (now - value_since_ < kPerValue) return;
  const std::chrono::duration<double> passed = now - value_since_;
  throughput_.push_back(static_cast<double>(new_samples_) / passed.count());
  if (throughput_.size() > kMostValues) throughput_.pop_front();
  new_value_ = throughput_.back();
  new_samples_ = 0;
  value_since_ = now;
}

}  // namespace hyades::coordinator
