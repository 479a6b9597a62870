// Films that differ, and films that are taken back.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "coordinator/scheduler/frame_ledger.h"

namespace hyades::coordinator {
namespace {

std::vector<Witness> witnesses_of(const Dispute& dispute) {
  std::vector<Witness> witnesses;
  for (const Opinion& o : dispute.opinions) witnesses.push_back(o.witness);
  return witnesses;
}

}  // namespace

size_t FrameLedger::disputes() const {
  return static_cast<size_t>(std::count_if(disputes_.begin(), disputes_.end(),
                                           [](const Dispute& d) { return d.differs; }));
}

Dispute* FrameLedger::find_dispute(const Extent& e) {
  const auto it = std::find_if(disputes_.begin(), disputes_.end(),
                               [&](const Dispute& d) { return d.extent == e; });
  return it == disputes_.end() ? nullptr : &*it;
}

std::vector<Witness> FrameLedger::heard(const Extent& e) const {
  const auto it = std::find_if(disputes_.begin(), disputes_.end(),
                               [&](const Dispute& d) { return d.extent == e; });
  return it == disputes_.end() ? std::vector<Witness>() : witnesses_of(*it);
}

Dispute& FrameLedger::open_dispute(const Extent& e, const Opinion& first) {
  return disputes_.emplace_back(Dispute{e, {first}, false});
}

void FrameLedger::end_dispute(const Extent& e) {
  std::erase_if(disputes_, [&](const Dispute& d) { return d.extent == e; });
}

std::optional<Extent> FrameLedger::next_check(Witness witness, const MayTry& may_try) const {
  for (const Dispute& d : disputes_) {
    const bool known = std::any_of(d.opinions.begin(), d.opinions.end(),
                                   [&](const Opinion& o) { return o.witness == witness; });
    if (known || being_checked(d.extent)) continue;
    if (!failed_.contains(d.extent)) return d.extent;
    // Those who have said what they think are no help: who failed it may be the only one left.
    if (may_try(failed_.workers(d.extent), witnesses_of(d))) return d.extent;
  }
  return std::nullopt;
}

uint64_t FrameLedger::waiting_checks() const {
  return static_cast<uint64_t>(
      std::count_if(disputes_.begin(), disputes_.end(),
                    [&](const Dispute& d) { return !being_checked(d.extent); }));
}

void FrameLedger::verify(const Extent& e) {
  for (HeldRecord& record : records_[e.tile]) {
    if (record.batches == e.batches) record.verified = true;
  }
}

std::vector<uint32_t> FrameLedger::unverified_tiles(WorkerId worker) const {
  std::vector<uint32_t> tiles;
  for (const auto& [tile, records] : records_) {
    if (std::any_of(records.begin(), records.end(),
                    [&](const HeldRecord& r) { return r.worker == worker && !r.verified; })) {
      tiles.push_back(tile);
    }
  }
  std::sort(tiles.begin(), tiles.end());
  return tiles;
}

std::vector<WorkerId> FrameLedger::unconfirmed() const {
  std::set<WorkerId> workers;
  for (const auto& [tile, records] : records_) {
    for (const HeldRecord& record : records) {
      if (!record.verified) workers.insert(record.worker);
    }
  }
  return {workers.begin(), workers.end()};
}

void FrameLedger::suspect_tile(uint32_t tile) {
  voiding_.emplace(tile, false);
  // All of it is rendered again: there is nothing left to quarrel about.
  std::erase_if(disputes_, [&](const Dispute& d) { return d.extent.tile == tile; });
}

std::vector<uint32_t> FrameLedger::newly_suspect() {
  std::vector<uint32_t> tiles;
  for (auto& [tile, named] : voiding_) {
    if (!named) tiles.push_back(tile);
    named = true;
  }
  return tiles;
}

std::vector<core::BatchRange> FrameLedger::void_tile(uint32_t tile) {
  voiding_.erase(tile);
  const core::BatchRange all{0, batches_};
  const auto records = records_.find(tile);
  if (records == records_.end()) return {};
  std::vector<core::BatchRange> voided;
  for (const HeldRecord& record : records->second) {
    if (record.pending == RecordId{}) durable_ -= record.batches.count;
    voided.push_back(record.batches);
  }
  records_.erase(records);
  const uint64_t before = BatchMap::count_free(held_, leased_, tile, all);
  held_.clear(tile, all);
  free_ += BatchMap::count_free(held_, leased_, tile, all) - before;
  if (!rounds_.empty()) begin_rounds_again(tile);
  open_.push_back({tile, {0, planned(tile)}});
  return voided;
}

}  // namespace hyades::coordinator
