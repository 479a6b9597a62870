#include "coordinator/web/farm_feed.h"

#include <cmath>
#include <cstddef>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/controller/all_pages.h"
#include "coordinator/controller/within_memory.h"
#include "farm/json_form.h"

namespace hyades::coordinator {
namespace {

constexpr std::chrono::seconds kPerValue{5};
constexpr size_t kMostValues = 720;  // an hour

/// Of snapshots that slow readers hold: where they are more, those who have had one for longest go.
constexpr size_t kMostSnapshotBytes = size_t{64} << 20U;

/// Bytes a second of what always changes, to each reader: a hundred of them are told a megabyte or
/// two. Of up to some hundred busy workers everything is told each second, of a thousand every few
/// seconds.
constexpr size_t kWorkerBytes = size_t{16} << 10U;
constexpr size_t kJobBytes = size_t{16} << 10U;

const std::set<std::string>& lively_of_workers() {
  static const std::set<std::string> fields{
      "leased", "units_done",  "samples_done", "heard_ms",     "memory_bytes",
      "work",   "cache_bytes", "cache_hits",   "cache_misses", "samples_per_second"};
  return fields;
}

const std::set<std::string>& lively_of_jobs() {
  static const std::set<std::string> fields{"samples_done",  "leased",       "samples_per_second",
                                            "seconds_left",  "core_seconds", "cost",
                                            "preview_frame", "noise"};
  return fields;
}

/// To three digits: a speed that stays what it is shall not look new each second.
double rounded(double speed) {
  if (!(speed > 0)) return 0;
  const double unit = std::pow(10.0, std::floor(std::log10(speed)) - 2);
  return std::round(speed / unit) * unit;
}

template <class Row>
farm::Json row_of(const Row& row) {
  farm::Json json = farm::to_json(row);
  json["samples_per_second"] = rounded(row.samples_per_second());
  return json;
}

}  // namespace

FarmFeed::FarmFeed(Controller& controller, Executors& executors)
    : controller_(controller),
      executors_(executors),
      jobs_(lively_of_jobs(), kJobBytes),
      workers_(lively_of_workers(), kWorkerBytes) {}

void FarmFeed::join(std::weak_ptr<LiveReader> reader) {
  {
    const core::MutexLock lock(mutex_);
    readers_.add(std::move(reader));
  }
  tick();
}

void FarmFeed::tick() {
  if (stepping_.exchange(true)) return;
  const bool taken = executors_.store.submit([me = shared_from_this()] {
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
  const std::vector<v1::Worker> workers = all_workers(controller_);
  note_throughput(workers);
  bool fresh = false;
  {
    const core::MutexLock lock(mutex_);
    fresh = readers_.has_fresh();
    if (readers_.empty()) {
      // Nobody has to be told what changes meanwhile.
      jobs_.clear();
      workers_.clear();
      info_ = {};
      new_value_.reset();
      return;
    }
  }
  const farm::Json change = changes(workers);
  // The bytes first: the network's thread waits for the lock.
  const auto changed = LiveReaders::event("change", change);
  LiveReaders::Bytes all;
  if (fresh) {
    all = LiveReaders::event("snapshot", {{"info", info_},
                                          {"jobs", jobs_.all()},
                                          {"workers", workers_.all()},
                                          {"samples_per_second", throughput_}});
  }
  const core::MutexLock lock(mutex_);
  if (!change.empty()) readers_.tell(changed);
  if (!fresh) return;
  LiveReaders::Group newcomers = readers_.take_fresh();
  LiveReaders::tell(newcomers, all);
  snapshots_.push_back({all, newcomers});
  readers_.know(std::move(newcomers));
  all.reset();
  cut_off_slow_readers();
}

/// Each second's newcomers have a snapshot of their own, which may be megabytes.
void FarmFeed::cut_off_slow_readers() {
  std::erase_if(snapshots_, [](const Unread& one) { return one.snapshot.expired(); });
  size_t bytes = 0;
  for (auto it = snapshots_.rbegin(); it != snapshots_.rend(); ++it) {
    if (const auto snapshot = it->snapshot.lock()) bytes += snapshot->size();
    if (bytes <= kMostSnapshotBytes) continue;
    for (const auto& weak : it->readers) {
      if (const auto reader = weak.lock()) reader->cut_off();
    }
  }
}

/// What is other than with the last step.
farm::Json FarmFeed::changes(const std::vector<v1::Worker>& workers) {
  farm::Json change = farm::Json::object();
  v1::InfoResponse asked;
  controller_.farm().info(asked);
  farm::Json info = farm::to_json(asked);
  if (info != info_) change["info"] = info;
  info_ = std::move(info);

  LiveRows::Rows workers_now;
  for (const v1::Worker& worker : workers) workers_now[worker.id()] = row_of(worker);
  farm::Json removed = farm::Json::array();
  farm::Json told = workers_.changes(workers_now, removed);
  if (!told.empty()) change["workers"] = std::move(told);
  if (!removed.empty()) change["removed_workers"] = std::move(removed);

  LiveRows::Rows jobs_now;
  farm::Json ended = tell_jobs(jobs_now);
  farm::Json gone = farm::Json::array();
  told = jobs_.changes(jobs_now, gone);
  std::set<farm::Json> ended_ids;
  for (farm::Json& job : ended) {
    ended_ids.insert(job["id"]);
    told.push_back(std::move(job));
  }
  if (!told.empty()) change["jobs"] = std::move(told);
  farm::Json deleted = farm::Json::array();
  for (const farm::Json& id : gone) {
    if (!ended_ids.contains(id)) deleted.push_back(id);
  }
  if (!deleted.empty()) change["removed_jobs"] = std::move(deleted);
  if (new_value_) change["samples_per_second"] = *new_value_;
  new_value_.reset();
  return change;
}

/// The open jobs; and, as JSON, those that were told of as open and have ended.
farm::Json FarmFeed::tell_jobs(LiveRows::Rows& jobs) {
  for (const v1::Job& job : all_open_jobs(controller_)) jobs[job.id()] = row_of(job);
  farm::Json ended = farm::Json::array();
  jobs_.each([&](uint64_t id, const farm::Json& job) {
    if (jobs.contains(id)) return;
    v1::GetJobResponse got;
    const grpc::Status status = controller_.queries().get(id, INT32_MAX, got);
    if (status.ok()) {
      ended.push_back(farm::to_json(got.job()));
    } else if (status.error_code() != grpc::StatusCode::NOT_FOUND) {
      jobs[id] = job;  // the store does not answer: what became of it is told later
    }
  });
  return ended;
}

void FarmFeed::note_throughput(const std::vector<v1::Worker>& workers) {
  std::map<uint64_t, uint64_t> samples;
  for (const v1::Worker& worker : workers) {
    samples[worker.id()] = worker.samples_done();
    const auto known = samples_.find(worker.id());
    if (known != samples_.end() && worker.samples_done() > known->second) {
      new_samples_ += worker.samples_done() - known->second;
    }
  }
  samples_ = std::move(samples);
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
