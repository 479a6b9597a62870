#include "coordinator/scheduler/frame_ledger.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

namespace hyades::coordinator {

FrameLedger::FrameLedger(const std::vector<uint32_t>& tile_order, uint32_t batches,
                         std::vector<uint32_t> rounds)
    : batches_(batches),
      tile_count_(static_cast<uint32_t>(tile_order.size())),
      rounds_(std::move(rounds)),
      held_(tile_count_, batches),
      leased_(tile_count_, batches) {
  const uint32_t first = rounds_.empty() ? batches : rounds_.front();
  total_ = free_ = uint64_t{tile_count_} * first;
  if (!rounds_.empty()) {
    rounds_of_.assign(tile_count_, {first});
    undecided_ = tile_count_;
  }
  for (const uint32_t tile : tile_order) open_.push_back({tile, {0, first}});
}

void FrameLedger::hold(const Extent& e, const HeldRecord& record) {
  free_ -= BatchMap::count_free(held_, leased_, e.tile, e.batches);
  held_.set(e.tile, e.batches);
  free_overlapping(e);
  records_[e.tile].push_back(record);
  if (record.pending == RecordId{}) durable_ += e.batches.count;
}

const HeldRecord* FrameLedger::find_held(const Extent& e) const {
  const auto tile = records_.find(e.tile);
  if (tile == records_.end()) return nullptr;
  for (const HeldRecord& record : tile->second) {
    if (record.batches == e.batches) return &record;
  }
  return nullptr;
}

void FrameLedger::made_durable(const Extent& e) {
  for (HeldRecord& record : records_[e.tile]) {
    if (record.batches == e.batches && record.pending != RecordId{}) {
      record.pending = RecordId{};
      durable_ += e.batches.count;
    }
  }
}

void FrameLedger::unhold(const Extent& e) {
  end_dispute(e);
  std::erase_if(records_[e.tile], [&](const HeldRecord& r) { return r.batches == e.batches; });
  held_.clear(e.tile, e.batches);
  free_ += BatchMap::count_free(held_, leased_, e.tile, e.batches);
  open_.push_front(e);
}

size_t FrameLedger::holders() const {
  size_t n = 0;
  for (const auto& [k, assignment] : assignments_) n += assignment.holders.size();
  return n;
}

std::vector<WorkerId> FrameLedger::holders_since(TimePoint time) const {
  std::vector<WorkerId> workers;
  for (const auto& [k, assignment] : assignments_) {
    // Who has a copy of it came later.
    if (assignment.since <= time) workers.push_back(assignment.holders.front().worker);
  }
  return workers;
}

bool FrameLedger::all_free(const Extent& e) const {
  return BatchMap::count_free(held_, leased_, e.tile, e.batches) == e.batches.count;
}

bool FrameLedger::may_assign(const Extent& e, Witness witness) const {
  const std::vector<Witness> others = heard(e);
  if (others.empty()) return is_planned(e) && all_free(e);
  return !being_checked(e) && std::find(others.begin(), others.end(), witness) == others.end();
}

void FrameLedger::lease_bits(const Extent& e) {
  free_ -= BatchMap::count_free(held_, leased_, e.tile, e.batches);
  leased_.set(e.tile, e.batches);
  free_overlapping(e);
}

/// A part of failed units that wait is free no more: the rest is ordinary work.
void FrameLedger::free_overlapping(const Extent& e) {
  for (const Extent& failed : failed_.take_overlapping(e)) {
    if (BatchMap::first_free(held_, leased_, failed.tile, failed.batches)) {
      open_.push_front(failed);
    }
  }
}

void FrameLedger::unlease_bits(const Extent& e) {
  leased_.clear(e.tile, e.batches);
  free_ += BatchMap::count_free(held_, leased_, e.tile, e.batches);
}

std::optional<Extent> FrameLedger::next_retry(const MayTry& may_try) {
  const std::optional<Extent> e = failed_.first(may_try);
  if (e) failed_.take_overlapping(*e);
  return e;
}

std::optional<Extent> FrameLedger::cut_open(const Extent& front, uint32_t run) {
  const auto free = BatchMap::first_free(held_, leased_, front.tile, front.batches);
  if (!free) return std::nullopt;
  const Extent cut{front.tile, {free->first, std::clamp(run, 1U, free->count)}};
  const uint32_t rest = cut.batches.end();
  if (rest < front.batches.end()) {
    // To the back: all tiles come on together, so that the picture grows evenly.
    open_.push_back({front.tile, {rest, front.batches.end() - rest}});
  }
  return cut;
}

bool FrameLedger::has_work(const MayTry& may_try) const {
  if (waits_for_checks()) return false;
  return free_ > failed_.waiting_batches() || failed_.first(may_try).has_value();
}

Assignment& FrameLedger::assign(const Extent& e, const Holder& holder, uint64_t serial) {
  lease_bits(e);
  Assignment& assignment = assignments_[key(e)];
  assignment.extent = e;
  assignment.serial = serial;
  assignment.holders.assign(1, holder);
  return assignment;
}

Assignment* FrameLedger::find_assignment(const Extent& e) {
  const auto it = assignments_.find(key(e));
  return it != assignments_.end() && it->second.extent == e ? &it->second : nullptr;
}

Assignment* FrameLedger::find_covering(const Extent& part, const LeaseId& lease) {
  // Assignments never overlap, so that the one that begins nearest before `part` is the only one.
  auto it = assignments_.upper_bound(key(part));
  if (it == assignments_.begin()) return nullptr;
  Assignment& nearest = (--it)->second;
  if (nearest.extent.tile != part.tile || nearest.extent.batches.end() < part.batches.end()) {
    return nullptr;
  }
  const auto holds = [&](const Holder& holder) { return holder.lease == lease; };
  const std::vector<Holder>& holders = nearest.holders;
  return std::any_of(holders.begin(), holders.end(), holds) ? &nearest : nullptr;
}

void FrameLedger::release(const Extent& e, const LeaseId& lease) {
  Assignment* assignment = find_assignment(e);
  if (assignment == nullptr) return;
  std::erase_if(assignment->holders, [&](const Holder& h) { return h.lease == lease; });
  if (!assignment->holders.empty()) return;
  assignments_.erase(key(e));
  unlease_bits(e);
  if (failed_.contains(e) && all_free(e)) {
    failed_.wait(e);
  } else {
    open_.push_front(e);
  }
}

std::vector<Holder> FrameLedger::end_assignment(const Extent& e) {
  Assignment* assignment = find_assignment(e);
  if (assignment == nullptr) return {};
  std::vector<Holder> holders = std::move(assignment->holders);
  assignments_.erase(key(e));
  unlease_bits(e);
  return holders;
}

std::string FrameLedger::audit() const {
  BatchMap reachable(tile_count_, batches_);
  for (const Extent& e : open_) reachable.set(e.tile, e.batches);
  for (const Extent& e : failed_.waiting()) {
    if (!all_free(e)) return fmt::format("a failed unit of tile {} waits and is not free", e.tile);
    reachable.set(e.tile, e.batches);
  }
  uint64_t free = 0;
  uint64_t held = 0;
  uint64_t recorded = 0;
  uint64_t durable = 0;
  uint64_t planned_batches = 0;
  uint64_t undecided = 0;
  for (uint32_t tile = 0; tile < tile_count_; ++tile) {
    const core::BatchRange beyond{planned(tile), batches_ - planned(tile)};
    if (BatchMap::count_free(held_, leased_, tile, beyond) != beyond.count) {
      return fmt::format("tile {} has batches that are not planned", tile);
    }
    planned_batches += planned(tile);
    undecided += is_undecided(tile);
    for (uint32_t b = 0; b < planned(tile); ++b) {
      const core::BatchRange one{b, 1};
      const bool is_free = BatchMap::count_free(held_, leased_, tile, one) == 1;
      free += is_free;
      held += held_.count(tile, one);
      if (is_free && reachable.count(tile, one) == 0) {
        return fmt::format("tile {} batch {} is free but can never be leased", tile, b);
      }
    }
    BatchMap seen(1, batches_);
    const auto records = records_.find(tile);
    if (records == records_.end()) continue;
    for (const HeldRecord& r : records->second) {
      if (seen.count(0, r.batches) != 0) return fmt::format("tile {} holds a batch twice", tile);
      seen.set(0, r.batches);
      recorded += r.batches.count;
      if (r.pending == RecordId{}) durable += r.batches.count;
    }
  }
  uint64_t leased = 0;
  uint64_t leased_bits = 0;
  for (uint32_t tile = 0; tile < tile_count_; ++tile)
    leased_bits += leased_.count(tile, {0, batches_});
  for (const auto& [k, a] : assignments_) {
    leased += a.extent.batches.count;
    if (a.holders.empty()) return "an assignment without a holder";
  }
  if (undecided != undecided_) {
    return fmt::format("{} tiles are undecided, {} counted", undecided, undecided_);
  }
  if (planned_batches != total_) {
    return fmt::format("{} batches are planned, {} counted", planned_batches, total_);
  }
  if (free != free_) return fmt::format("{} batches are free, {} counted", free, free_);
  if (held != recorded) return fmt::format("{} batches are held, {} recorded", held, recorded);
  if (durable != durable_) return fmt::format("{} are durable, {} counted", durable, durable_);
  if (leased != leased_bits) return fmt::format("{} are leased, {} marked", leased, leased_bits);
  return {};
}

}  // namespace hyades::coordinator
