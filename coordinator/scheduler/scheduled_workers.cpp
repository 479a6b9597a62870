#include "coordinator/scheduler/scheduled_workers.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "core/base/hash.h"

namespace hyades::coordinator {
namespace {

constexpr uint64_t kNamed = uint64_t{1} << 63U;  ///< no worker has such a number, and it is not 0

/// Of a name that somebody gives. Nobody finds another name with the number of a given one.
uint64_t number_of(const std::string& name) {
  const core::Sha256 digest = core::sha256(name);
  uint64_t number = 0;
  for (size_t i = 0; i < sizeof number; ++i) {
    number = (number << 8U) | static_cast<uint64_t>(digest[i]);
  }
  return number | kNamed;
}

Witness witness_of(const WorkerJoined& joined) {
  if (joined.credential.empty()) return Witness{static_cast<uint64_t>(joined.worker)};
  return Witness{number_of(joined.credential)};
}

Origin origin_of(const WorkerJoined& joined) {
  if (joined.origin.empty()) return Origin{static_cast<uint64_t>(witness_of(joined))};
  return Origin{number_of(joined.origin)};
}

/// Whether it renders, or would.
bool is_at_work(const Worker& worker) {
  return !worker.barred && (worker.wanted > 0 || !worker.leases.empty());
}

/// How often workers of this origin and class have left the frame: the less, the better.
int claim_of(const FrameSlot& slot, Origin origin, ClassId worker_class, TimePoint now) {
  int claim = 0;
  for (const FrameSlot::Left& left : slot.left) {
    if (left.origin != origin || left.until <= now) continue;
    if (left.worker_class == worker_class) return 2;
    claim = 1;
  }
  return claim;
}

}  // namespace

ClassId class_id(core::RenderClass of, const std::string& name) {
  return ClassId{number_of(core::kRenderClassNames[static_cast<size_t>(of)] + " " + name)};
}

std::vector<TagId> tag_ids(const std::vector<std::string>& tags) {
  std::vector<TagId> ids;
  for (const std::string& tag : tags) ids.push_back(TagId{number_of(tag)});
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
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
  worker.witness = witness_of(joined);
  worker.origin = origin_of(joined);
  worker.threads = joined.threads;
  worker.tags = tag_ids(joined.tags);
  worker.memory = joined.memory;
  worker.in_line = step_.now;
  worker.joined = step_.now;
  threads_ += worker.threads;
  worker.barred = quarantined(joined.worker);
  join_class(worker, core::RenderClass::native, joined.worker_class);
  if (!joined.portable_class.empty()) {
    join_class(worker, core::RenderClass::portable, joined.portable_class);
  }
  if (!worker.barred) count_able(joined.worker, worker, true);
  return worker;
}

void ScheduledWorkers::join_class(Worker& worker, core::RenderClass which,
                                  const std::string& name) {
  const ClassId id = class_id(which, name);
  worker.classes[static_cast<size_t>(which)] = id;
  Class& of_it = classes_[id];
  of_it.name = name;
  of_it.of = which;
  ++of_it.connected;
}

void ScheduledWorkers::remove(WorkerId id) {
  const auto it = workers_.find(id);
  const Worker& worker = it->second;
  if (worker.waiting != 0) waiting_.erase(worker.waiting);
  threads_ -= worker.threads;
  if (!worker.barred) count_able(id, worker, false);
  for (const ClassId worker_class : worker.classes) {
    const auto of_it = classes_.find(worker_class);
    if (of_it != classes_.end() && --of_it->second.connected == 0) classes_.erase(of_it);
  }
  workers_.erase(it);
}

void ScheduledWorkers::note_given_back(WorkerId id, uint32_t units) {
  if (units == 0) return;
  constexpr uint32_t kMayGiveBack = 64;
  constexpr Duration kRestPerUnit = std::chrono::milliseconds(10);
  constexpr Duration kLongestRest = std::chrono::minutes(1);
  GivenBack& given = given_back_[id];
  given.units = std::min(given.units + units, 1'000'000U);
  if (given.units <= kMayGiveBack) return;
  given.rests_until =
      step_.now + std::min(kLongestRest, (given.units - kMayGiveBack) * kRestPerUnit);
}

bool ScheduledWorkers::rests(WorkerId id) const {
  const auto given = given_back_.find(id);
  return given != given_back_.end() && step_.now < given->second.rests_until;
}

void ScheduledWorkers::bar(WorkerId id, Worker& worker, bool barred) {
  if (std::exchange(worker.barred, barred) == barred) return;
  count_able(id, worker, !barred);
}

void ScheduledWorkers::forget_failures(WorkerId id) {
  // Its reason may be asked for when others have rendered what it failed before.
  if (const auto it = failures_.find(id); it != failures_.end()) it->second.count = 0;
}

void ScheduledWorkers::pardon(WorkerId id) {
  quarantined_.erase(id);
  failures_.erase(id);
}

bool ScheduledWorkers::is_lone(const ScheduledJob& job, ClassId worker_class) const {
  if (worker_class == ClassId{}) return false;
  const auto it = classes_.find(worker_class);
  const size_t origins = it == classes_.end() ? 0 : it->second.origins.size();
  const size_t at_work = classes_at_work_[static_cast<size_t>(job.plan.needs.render_class)];
  return origins <= 1 && at_work > origins;
}

std::vector<Origin> ScheduledWorkers::origins_of(ClassId worker_class) const {
  std::vector<Origin> found;
  const auto it = classes_.find(worker_class);
  if (it == classes_.end()) return found;
  for (const auto& [origin, workers] : it->second.origins) found.push_back(origin);
  return found;
}

bool ScheduledWorkers::anybody_of_another(const ScheduledJob& job, ClassId worker_class) const {
  return std::any_of(workers_.begin(), workers_.end(), [&](const auto& entry) {
    const Worker& other = entry.second;
    return is_at_work(other) && other.class_for(job) != worker_class && suits(job, other) &&
           !is_slow(other);
  });
}

void ScheduledWorkers::note_slow(ClassId worker_class, TimePoint since,
                                 const std::vector<WorkerId>& holders, TimePoint until) {
  const auto it = classes_.find(worker_class);
  if (it == classes_.end()) return;
  const std::map<Origin, uint32_t>& origins = it->second.origins;
  const bool others = std::any_of(workers_.begin(), workers_.end(), [&](const auto& entry) {
    return !entry.second.barred && !origins.contains(entry.second.origin);
  });
  for (const auto& [id, worker] : workers_) {
    if (worker.barred || worker.class_in(it->second.of) != worker_class) continue;
    const bool held = std::find(holders.begin(), holders.end(), id) != holders.end();
    if (!held && worker.delivered && *worker.delivered >= since) continue;
    slow_witnesses_[worker.witness] = until;
    // Else everybody is of this origin.
    if (others) slow_origins_[worker.origin] = {step_.now, until};
  }
}

bool ScheduledWorkers::is_slow(const Worker& worker) const {
  const auto witness = slow_witnesses_.find(worker.witness);
  const auto origin = slow_origins_.find(worker.origin);
  return (witness != slow_witnesses_.end() && witness->second > step_.now) ||
         (origin != slow_origins_.end() && origin->second.until > step_.now &&
          worker.joined >= origin->second.since);
}

bool ScheduledWorkers::forgive_slow() {
  const auto is_over = [&](const auto& entry) { return entry.second <= step_.now; };
  const auto has_ended = [&](const auto& entry) { return entry.second.until <= step_.now; };
  return std::erase_if(slow_witnesses_, is_over) + std::erase_if(slow_origins_, has_ended) > 0;
}

bool ScheduledWorkers::anybody_with_better_claim(const ScheduledJob& job, const FrameSlot& slot,
                                                 const Worker& worker) const {
  const int claim = claim_of(slot, worker.origin, worker.class_for(job), step_.now);
  return std::any_of(workers_.begin(), workers_.end(), [&](const auto& entry) {
    const Worker& other = entry.second;
    return claim_of(slot, other.origin, other.class_for(job), step_.now) < claim &&
           is_at_work(other) && suits(job, other) && !is_slow(other);
  });
}

bool ScheduledWorkers::may_render(const ScheduledJob& job, const FrameSlot& slot,
                                  const Worker& worker) const {
  const ClassId own = worker.class_for(job);
  if (own == ClassId{}) return false;
  if (slot.worker_class != ClassId{}) return slot.worker_class == own;
  if (!slot.left.empty() && anybody_with_better_claim(job, slot, worker)) return false;
  return !is_slow(worker) || !anybody_of_another(job, own);
}

bool ScheduledWorkers::anybody_for(const ScheduledJob& job, ClassId worker_class) const {
  const auto it = classes_.find(worker_class);
  if (it == classes_.end() || it->second.origins.empty()) return false;
  if (!job.plan.needs.any()) return true;
  const std::set<WorkerId>& able = it->second.able;
  return std::any_of(able.begin(), able.end(),
                     [&](WorkerId id) { return suits(job, workers_.at(id)); });
}

/// One worker more or less that may get units.
void ScheduledWorkers::count_able(WorkerId id, const Worker& worker, bool one_more) {
  for (const ClassId worker_class : worker.classes) {
    if (worker_class == ClassId{}) continue;
    Class& of_it = classes_[worker_class];
    std::map<Origin, uint32_t>& origins = of_it.origins;
    size_t& at_work = classes_at_work_[static_cast<size_t>(of_it.of)];
    if (one_more) {
      of_it.able.insert(id);
      if (origins.empty()) ++at_work;
      ++origins[worker.origin];
      continue;
    }
    of_it.able.erase(id);
    if (const auto it = origins.find(worker.origin); --it->second == 0) origins.erase(it);
    if (origins.empty()) --at_work;
  }
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
  return job.group->needs.are_met(worker);
}

uint64_t ScheduledWorkers::count(const Needs& needs) const {
  return static_cast<uint64_t>(
      std::count_if(workers_.begin(), workers_.end(),
                    [&](const auto& entry) { return needs.are_met(entry.second); }));
}

bool ScheduledWorkers::may_try(const ScheduledJob& job, WorkerId id, const Worker& worker,
                               const std::vector<WorkerId>& blamed,
                               const std::vector<Witness>& heard) const {
  return !std::binary_search(blamed.begin(), blamed.end(), id) ||
         !anybody_besides(blamed, heard, job, worker.class_for(job));
}

bool ScheduledWorkers::anybody_besides(const std::vector<WorkerId>& tried,
                                       const std::vector<Witness>& heard, const ScheduledJob& job,
                                       ClassId worker_class) const {
  const auto it = classes_.find(worker_class);
  if (it == classes_.end()) return false;
  const std::set<WorkerId>& able = it->second.able;
  return std::any_of(able.begin(), able.end(), [&](WorkerId id) {
    if (std::binary_search(tried.begin(), tried.end(), id)) return false;
    const Worker& other = workers_.at(id);
    return suits(job, other) && std::find(heard.begin(), heard.end(), other.witness) == heard.end();
  });
}

bool ScheduledWorkers::may_join(const ScheduledJob& job, WorkerId id, const Worker& worker) {
  const bool room = job.plan.max_workers == 0 || job.workers.size() < job.plan.max_workers ||
                    job.workers.contains(id);
  return room && suits(job, worker);
}

}  // namespace hyades::coordinator
