#include "coordinator/scheduler/failed_units.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace hyades::coordinator {

void FailedUnits::blame(const Extent& e, WorkerId worker, Witness witness) {
  const auto [at, fresh] = units_.try_emplace(key(e), Unit{groups_.end(), {}, 0, 0});
  Unit& unit = at->second;
  ++unit.failures;
  if (std::find(unit.witnesses.begin(), unit.witnesses.end(), witness) == unit.witnesses.end()) {
    unit.witnesses.push_back(witness);
  }
  std::vector<WorkerId> workers = fresh ? std::vector<WorkerId>() : unit.group->first;
  const auto place = std::lower_bound(workers.begin(), workers.end(), worker);
  if (place == workers.end() || *place != worker) {
    workers.insert(place, worker);
    if (!fresh) leave(unit.group);
    unit.group = groups_.try_emplace(std::move(workers)).first;
    ++unit.group->second.units;
  }
}

const std::vector<WorkerId>& FailedUnits::workers(const Extent& e) const {
  static const std::vector<WorkerId> kNobody;
  const auto found = units_.find(key(e));
  return found == units_.end() ? kNobody : found->second.group->first;
}

std::vector<Witness> FailedUnits::witnesses(const Extent& e) const {
  const auto found = units_.find(key(e));
  return found == units_.end() ? std::vector<Witness>() : found->second.witnesses;
}

size_t FailedUnits::failures(const Extent& e) const {
  const auto found = units_.find(key(e));
  return found == units_.end() ? 0 : found->second.failures;
}

std::vector<WorkerId> FailedUnits::forgive(const Extent& e) {
  const auto found = units_.find(key(e));
  if (found == units_.end() || found->second.serial != 0) return {};
  std::vector<WorkerId> workers = found->second.group->first;
  leave(found->second.group);
  units_.erase(found);
  return workers;
}

void FailedUnits::leave(Groups::iterator group) {
  if (--group->second.units == 0) groups_.erase(group);
}

void FailedUnits::wait(const Extent& e) {
  Unit& unit = units_.at(key(e));
  if (unit.serial != 0) return;
  unit.serial = next_serial_++;
  std::map<uint64_t, Extent>& of_group = unit.group->second.waiting;
  if (of_group.empty()) by_age_.emplace(unit.serial, unit.group);
  of_group.emplace(unit.serial, e);
  waiting_.emplace(key(e), e);
  waiting_batches_ += e.batches.count;
}

void FailedUnits::stop_waiting(Unit& unit, const Extent& e) {
  std::map<uint64_t, Extent>& of_group = unit.group->second.waiting;
  if (of_group.begin()->first == unit.serial) {
    by_age_.erase(unit.serial);
    const auto next = std::next(of_group.begin());
    if (next != of_group.end()) by_age_.emplace(next->first, unit.group);
  }
  of_group.erase(std::exchange(unit.serial, 0));
  waiting_.erase(key(e));
  waiting_batches_ -= e.batches.count;
}

bool FailedUnits::waits(const Extent& e) const { return waiting_.contains(key(e)); }

std::optional<Extent> FailedUnits::first(const MayTry& may_try) const {
  for (const auto& [serial, group] : by_age_) {
    if (may_try(group->first, {})) return group->second.waiting.begin()->second;
  }
  return std::nullopt;
}

std::vector<Extent> FailedUnits::take_overlapping(const Extent& e) {
  std::vector<Extent> taken;
  auto it = waiting_.lower_bound({e.tile, e.batches.first, 0});
  // They do not overlap each other: one at most begins before and reaches into it.
  if (it != waiting_.begin()) {
    const auto before = std::prev(it);
    const Extent& last = before->second;
    if (last.tile == e.tile && last.batches.end() > e.batches.first) it = before;
  }
  for (; it != waiting_.end(); ++it) {
    const Extent& one = it->second;
    if (one.tile != e.tile || one.batches.first >= e.batches.end()) break;
    taken.push_back(one);
  }
  for (const Extent& one : taken) stop_waiting(units_.at(key(one)), one);
  return taken;
}

std::vector<Extent> FailedUnits::waiting() const {
  std::vector<Extent> all;
  all.reserve(waiting_.size());
  for (const auto& [at, e] : waiting_) all.push_back(e);
  return all;
}

}  // namespace hyades::coordinator
