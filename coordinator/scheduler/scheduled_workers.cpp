#include "coordinator/scheduler/scheduled_workers.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "core/base/hash.h"

namespace hyades::coordinator {
namespace {

/// No table of credentials is kept, as whoever invents many would fill it: they are hashed.
Voice voice_of(const WorkerJoined& joined) {
  constexpr uint64_t kOfCredential = uint64_t{1} << 63U;  // no worker has such a number
  if (joined.credential.empty()) return Voice{static_cast<uint64_t>(joined.worker)};
  const core::Sha256 digest = core::sha256(joined.credential);
  uint64_t number = 0;
  for (size_t i = 0; i < sizeof number; ++i) {
    number = (number << 8U) | static_cast<uint64_t>(digest[i]);
  }
  return Voice{number | kOfCredential};
}

}  // namespace

ScheduledWorkers::ScheduledWorkers(Step& step) : step_(step) {
  class_names_.emplace_back();
  class_workers_.push_back(0);
  class_gone_.emplace_back();
}

Worker* ScheduledWorkers::find(WorkerId id) {
  const auto it = workers_.find(id);
  return it == workers_.end() ? nullptr : &it->second;
}

const Worker* ScheduledWorkers::find(WorkerId id) const {
  const auto it = workers_.find(id);
  return it == workers_.end() ? nullptr : &it->second;
}

Worker& ScheduledWorkers::add(const WorkerJoined& joined) {
  Worker& worker = workers_[joined.worker];
  worker.voice = voice_of(joined);
  worker.threads = joined.threads;
  worker.worker_class = intern_class(joined.worker_class);
  worker.tags = intern_tags(joined.tags);
  worker.memory = joined.memory;
  worker.in_line = step_.now;
  threads_ += worker.threads;
  worker.barred = quarantined(joined.worker);
  if (!worker.barred) count_class(worker.worker_class, 1);
  return worker;
}

void ScheduledWorkers::remove(WorkerId id) {
  const auto it = workers_.find(id);
  const Worker& worker = it->second;
  if (worker.waiting != 0) waiting_.erase(worker.waiting);
  threads_ -= worker.threads;
  if (!worker.barred) count_class(worker.worker_class, -1);
  workers_.erase(it);
}

void ScheduledWorkers::bar(Worker& worker, bool barred) {
  if (std::exchange(worker.barred, barred) == barred) return;
  count_class(worker.worker_class, barred ? -1 : 1);
}

void ScheduledWorkers::pardon(WorkerId id) {
  quarantined_.erase(id);
  failures_.erase(id);
}

uint32_t ScheduledWorkers::intern_class(const std::string& name) {
  const auto [it, fresh] =
      class_index_.try_emplace(name, static_cast<uint32_t>(class_names_.size()));
  if (fresh) {
    class_names_.push_back(name);
    class_workers_.push_back(0);
    class_gone_.push_back(step_.now);
  }
  return it->second;
}

std::vector<uint32_t> ScheduledWorkers::intern_tags(const std::vector<std::string>& tags) {
  std::vector<uint32_t> numbers;
  for (const std::string& tag : tags) {
    const auto next = static_cast<uint32_t>(tag_index_.size());
    numbers.push_back(tag_index_.try_emplace(tag, next).first->second);
  }
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

bool ScheduledWorkers::anybody_for(const ScheduledJob& job, uint32_t worker_class) const {
  if (!job.plan.needs.any()) return class_workers_[worker_class] > 0;
  return std::any_of(workers_.begin(), workers_.end(), [&](const auto& entry) {
    return !entry.second.barred && entry.second.worker_class == worker_class &&
           suits(job, entry.second);
  });
}

/// One worker of the class more or less that may get units.
void ScheduledWorkers::count_class(uint32_t worker_class, int change) {
  class_workers_[worker_class] += static_cast<uint32_t>(change);
  if (change < 0 && class_workers_[worker_class] == 0) class_gone_[worker_class] = step_.now;
}

void ScheduledWorkers::update_waiting(WorkerId id, Worker& worker) {
  if (worker.wanted > 0 && worker.waiting == 0) {
    worker.waiting = next_waiting_++;
    waiting_.emplace(worker.waiting, id);
  } else if (worker.wanted == 0 && worker.waiting != 0) {
    waiting_.erase(worker.waiting);
    worker.waiting = 0;
  }
}

/// Whether the worker could render units of the job at all.
bool ScheduledWorkers::suits(const ScheduledJob& job, const Worker& worker) {
  const uint64_t memory = job.plan.needs.memory;
  return (memory == 0 || worker.memory == 0 || worker.memory >= memory) &&
         std::includes(worker.tags.begin(), worker.tags.end(), job.tags.begin(), job.tags.end());
}

bool ScheduledWorkers::may_try(const ScheduledJob& job, WorkerId id, const Worker& worker,
                               const std::vector<WorkerId>& blamed,
                               const std::vector<Voice>& heard) const {
  return std::find(blamed.begin(), blamed.end(), id) == blamed.end() ||
         !anybody_besides(blamed, heard, job, worker.worker_class);
}

bool ScheduledWorkers::anybody_besides(const std::vector<WorkerId>& tried,
                                       const std::vector<Voice>& heard, const ScheduledJob& job,
                                       uint32_t worker_class) const {
  return std::any_of(workers_.begin(), workers_.end(), [&](const auto& entry) {
    return !entry.second.barred && entry.second.worker_class == worker_class &&
           suits(job, entry.second) &&
           std::find(tried.begin(), tried.end(), entry.first) == tried.end() &&
           std::find(heard.begin(), heard.end(), entry.second.voice) == heard.end();
  });
}

bool ScheduledWorkers::may_join(const ScheduledJob& job, WorkerId id, const Worker& worker) {
  const bool room = job.plan.max_workers == 0 || job.workers.size() < job.plan.max_workers ||
                    job.workers.contains(id);
  return room && suits(job, worker);
}

}  // namespace hyades::coordinator
