// Tiles that get more batches until somebody has found that they have enough.
#include <algorithm>
#include <cstdint>
#include <vector>

#include "coordinator/scheduler/frame_ledger.h"

namespace hyades::coordinator {

/// How many batches a tile gets next that has so many.
uint32_t FrameLedger::round_after(uint32_t batches) const {
  const auto next = std::upper_bound(rounds_.begin(), rounds_.end(), batches);
  return next == rounds_.end() ? batches_ : *next;
}

/// More batches of the tile are planned, which are free.
void FrameLedger::extend(uint32_t tile, uint32_t planned) {
  TileRounds& rounds = rounds_of_[tile];
  const uint32_t more = planned - rounds.planned;
  open_.push_back({tile, {rounds.planned, more}});
  rounds.planned = planned;
  total_ += more;
  free_ += more;
  if (planned == batches_) --undecided_;
}

void FrameLedger::plan_for(const Extent& e) {
  while (!is_planned(e)) extend(e.tile, round_after(planned(e.tile)));
}

bool FrameLedger::is_to_judge(uint32_t tile) const {
  if (!is_undecided(tile) || rounds_of_[tile].asked != 0 || is_suspect(tile)) return false;
  const auto records = records_.find(tile);
  if (records == records_.end()) return false;
  uint32_t durable = 0;
  for (const HeldRecord& record : records->second) {
    if (record.pending == RecordId{}) durable += record.batches.count;
  }
  return durable == planned(tile);
}

std::vector<uint32_t> FrameLedger::to_judge() const {
  std::vector<uint32_t> tiles;
  for (uint32_t tile = 0; tile < rounds_of_.size(); ++tile) {
    if (is_to_judge(tile)) tiles.push_back(tile);
  }
  return tiles;
}

bool FrameLedger::judge(uint32_t tile, uint64_t serial, bool enough) {
  if (tile >= rounds_of_.size() || rounds_of_[tile].asked != serial) return false;
  rounds_of_[tile].asked = 0;
  --questions_;
  if (is_suspect(tile)) return false;
  if (enough) {
    rounds_of_[tile].enough = true;
    --undecided_;
  } else {
    extend(tile, round_after(planned(tile)));
  }
  return true;
}

std::vector<Extent> FrameLedger::assigned_beyond_first_round(uint32_t tile) const {
  std::vector<Extent> extents;
  if (rounds_.empty()) return extents;
  for (const auto& [k, assignment] : assignments_) {
    const Extent& e = assignment.extent;
    if (e.tile == tile && e.batches.end() > rounds_.front()) extents.push_back(e);
  }
  return extents;
}

/// The tile, of which nothing is held and nothing beyond the first round is leased, is as it was in
/// the beginning.
void FrameLedger::begin_rounds_again(uint32_t tile) {
  TileRounds& rounds = rounds_of_[tile];
  if (!is_undecided(tile)) ++undecided_;
  const uint32_t fewer = rounds.planned - rounds_.front();
  total_ -= fewer;
  free_ -= fewer;
  if (rounds.asked != 0) --questions_;
  rounds = {rounds_.front()};
  std::erase_if(open_, [tile](const Extent& e) { return e.tile == tile; });
  failed_.take_overlapping({tile, {0, batches_}});
}

}  // namespace hyades::coordinator
