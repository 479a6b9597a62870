#include "core/film/coverage.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <limits>

#include "core/film/coverage_cut.h"

namespace hyades::core {
namespace {

constexpr int32_t kBucketRows = 32;
constexpr int32_t kTallBuckets = 64;    // boxes over more buckets than this are listed apart
constexpr size_t kIndexFromBoxes = 32;  // below, scanning all boxes is faster
constexpr uint64_t kMaxPiecesPerBox = 64;
constexpr uint64_t kMinAddsToTidy = 256;  // tidying costs about as much as adding what is there

int32_t bucket_of(int32_t y) { return y >= 0 ? y / kBucketRows : -1 - (-1 - y) / kBucketRows; }

bool empty(const CoverageBox& box) { return box.tile.empty() || box.batches.count == 0; }

uint64_t box_volume(const CoverageBox& box) {
  return empty(box) ? 0 : static_cast<uint64_t>(box.tile.area()) * box.batches.count;
}

CoverageBox common(const CoverageBox& a, const CoverageBox& b) {
  const uint32_t first = std::max(a.batches.first, b.batches.first);
  const uint32_t end = std::min(a.batches.end(), b.batches.end());
  return {intersection(a.tile, b.tile), {first, end > first ? end - first : 0}};
}

/// If both make one box together, their union.
std::optional<CoverageBox> joined(const CoverageBox& a, const CoverageBox& b) {
  const bool same_x = a.tile.x0 == b.tile.x0 && a.tile.x1 == b.tile.x1;
  const bool same_y = a.tile.y0 == b.tile.y0 && a.tile.y1 == b.tile.y1;
  const bool same_batches = a.batches == b.batches;
  if (same_x && same_y) {
    if (a.batches.end() == b.batches.first) {
      return CoverageBox{a.tile, {a.batches.first, a.batches.count + b.batches.count}};
    }
    if (b.batches.end() == a.batches.first) {
      return CoverageBox{a.tile, {b.batches.first, a.batches.count + b.batches.count}};
    }
  } else if (same_batches && same_y && (a.tile.x1 == b.tile.x0 || b.tile.x1 == a.tile.x0)) {
    return CoverageBox{
        {std::min(a.tile.x0, b.tile.x0), a.tile.y0, std::max(a.tile.x1, b.tile.x1), a.tile.y1},
        a.batches};
  } else if (same_batches && same_x && (a.tile.y1 == b.tile.y0 || b.tile.y1 == a.tile.y0)) {
    return CoverageBox{
        {a.tile.x0, std::min(a.tile.y0, b.tile.y0), a.tile.x1, std::max(a.tile.y1, b.tile.y1)},
        a.batches};
  }
  return std::nullopt;
}

}  // namespace

/// Calls visit(id) for the boxes that may touch rows [y0, y1), perhaps more than once, until it
/// returns true.
template <class Visit>
bool Coverage::any_in_rows(int32_t y0, int32_t y1, const Visit& visit) const {
  if (!indexed_) {
    for (uint32_t id = 0; id < boxes_.size(); ++id) {
      if (visit(id)) return true;
    }
    return false;
  }
  const int64_t first = std::max<int64_t>(int64_t{bucket_of(y0)} - first_bucket_, 0);
  const int64_t end = std::min<int64_t>(int64_t{bucket_of(y1 - 1)} + 1 - first_bucket_,
                                        static_cast<int64_t>(buckets_.size()));
  for (int64_t i = first; i < end; ++i) {
    for (const uint32_t id : buckets_[static_cast<size_t>(i)]) {
      if (visit(id)) return true;
    }
  }
  return std::any_of(tall_.begin(), tall_.end(), visit);
}

std::optional<CoverageBox> Coverage::overlap(const CoverageBox& box) const {
  if (empty(box)) return std::nullopt;
  CoverageBox found;
  const bool any = any_in_rows(box.tile.y0, box.tile.y1, [&](uint32_t id) {
    found = common(boxes_[id], box);
    return !empty(found);
  });
  return any ? std::optional(found) : std::nullopt;
}

bool Coverage::contains(const CoverageBox& box) const {
  if (empty(box)) return true;
  std::vector<uint32_t> touching;
  any_in_rows(box.tile.y0, box.tile.y1, [&](uint32_t id) {
    if (!empty(common(boxes_[id], box))) touching.push_back(id);
    return false;
  });
  std::sort(touching.begin(), touching.end());
  touching.erase(std::unique(touching.begin(), touching.end()), touching.end());
  uint64_t held = 0;
  for (const uint32_t id : touching) held += box_volume(common(boxes_[id], box));
  return held == box_volume(box);
}

void Coverage::add(const CoverageBox& box) {
  if (empty(box)) return;
  assert(!overlap(box) && "a batch counts once");
  volume_ += box_volume(box);
  CoverageBox grown = box;
  while (join(grown)) {
  }
  insert(grown);
  if (++adds_since_tidy_ >= std::max<uint64_t>(kMinAddsToTidy, boxes_.size())) tidy();
}

/// Joins `box` with a held neighbour, which is taken out; batches first, since the batches of one
/// tile are what most often arrives in pieces.
bool Coverage::join(CoverageBox& box) {
  std::optional<uint32_t> neighbour;
  any_in_rows(box.tile.y0, box.tile.y0 + 1, [&](uint32_t id) {
    const CoverageBox& other = boxes_[id];
    if (other.tile.y0 != box.tile.y0 || !joined(other, box)) return false;
    neighbour = id;
    return other.tile == box.tile;
  });
  if (!neighbour) {
    const auto sees = [&](uint32_t id) {
      if (!joined(boxes_[id], box)) return false;
      neighbour = id;
      return true;
    };
    if (!any_in_rows(box.tile.y0 - 1, box.tile.y0, sees)) {
      any_in_rows(box.tile.y1, box.tile.y1 + 1, sees);
    }
  }
  if (!neighbour) return false;
  box = *joined(boxes_[*neighbour], box);
  remove(*neighbour);
  return true;
}

void Coverage::insert(const CoverageBox& box) {
  boxes_.push_back(box);
  if (indexed_) {
    link(static_cast<uint32_t>(boxes_.size() - 1));
  } else if (boxes_.size() > kIndexFromBoxes) {
    indexed_ = true;
    for (uint32_t id = 0; id < boxes_.size(); ++id) link(id);
  }
}

void Coverage::remove(uint32_t id) {
  const auto last = static_cast<uint32_t>(boxes_.size() - 1);
  if (indexed_) {
    unlink(id);
    if (id != last) unlink(last);
  }
  boxes_[id] = boxes_[last];
  boxes_.pop_back();
  if (indexed_ && id != last) link(id);
}

void Coverage::link(uint32_t id) {
  const int32_t first = bucket_of(boxes_[id].tile.y0);
  const int32_t end = bucket_of(boxes_[id].tile.y1 - 1) + 1;
  // Also a box far away from the others must not make the index long.
  const int64_t low = buckets_.empty() ? first : std::min(first, first_bucket_);
  const int64_t high =
      buckets_.empty() ? end : std::max(int64_t{end}, first_bucket_ + int64_t(buckets_.size()));
  if (int64_t{end} - first > kTallBuckets || high - low > int64_t{64} * kTallBuckets) {
    tall_.push_back(id);
    return;
  }
  if (buckets_.empty()) first_bucket_ = first;
  if (low < first_bucket_) {
    buckets_.insert(buckets_.begin(), static_cast<size_t>(first_bucket_ - low), {});
    first_bucket_ = static_cast<int32_t>(low);
  }
  buckets_.resize(static_cast<size_t>(high - low));
  for (int32_t i = first; i < end; ++i) {
    buckets_[static_cast<size_t>(i - first_bucket_)].push_back(id);
  }
}

void Coverage::unlink(uint32_t id) {
  const auto take_out = [id](std::vector<uint32_t>& ids) {
    const auto at = std::find(ids.begin(), ids.end(), id);
    if (at == ids.end()) return false;
    *at = ids.back();
    ids.pop_back();
    return true;
  };
  const int32_t first = bucket_of(boxes_[id].tile.y0);
  const int32_t end = bucket_of(boxes_[id].tile.y1 - 1) + 1;
  if (first < first_bucket_ || end - first_bucket_ > static_cast<int64_t>(buckets_.size())) {
    take_out(tall_);
    return;
  }
  for (int32_t i = first; i < end; ++i) {
    // A tall box is in none of the buckets, a linked one in all of its own.
    if (!take_out(buckets_[static_cast<size_t>(i - first_bucket_)])) {
      take_out(tall_);
      return;
    }
  }
}

void Coverage::tidy() {
  adds_since_tidy_ = 0;
  const auto fresh = cut_and_join(boxes_, kMaxPiecesPerBox * boxes_.size());
  if (!fresh || fresh->size() >= boxes_.size()) return;
  boxes_.clear();
  buckets_.clear();
  tall_.clear();
  indexed_ = false;
  for (const CoverageBox& box : *fresh) insert(box);
}

std::vector<CoverageBox> Coverage::canonical() const {
  return cut_and_join(boxes_, std::numeric_limits<uint64_t>::max()).value();
}

Result<Coverage> Coverage::from_canonical(const std::vector<CoverageBox>& boxes) {
  for (const CoverageBox& box : boxes) {
    if (box.batches.first > kMaxBatches || box.batches.count > kMaxBatches - box.batches.first) {
      return Error{"it has batches beyond any job's"};
    }
  }
  // Boxes in canonical form are cut no further, so that hostile ones cannot make this slow.
  if (cut_and_join(boxes, boxes.size()) != boxes) {
    return Error{"its boxes overlap, are empty or are not in canonical form"};
  }
  Coverage coverage;
  for (const CoverageBox& box : boxes) {
    coverage.insert(box);
    coverage.volume_ += box_volume(box);
  }
  return coverage;
}

}  // namespace hyades::core
