#include "core/film/splats.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <span>
#include <utility>

#include "core/base/hash.h"

namespace hyades::core {
namespace {

/// A layer that touches more than one pixel in so many takes about as much memory with all of them.
constexpr size_t kSparse = 2;
/// kSparse of layers to which others are added: each time costs as much as there are entries.
constexpr size_t kSparseSum = 16;

constexpr size_t kEntriesPerPiece = 4096;

}  // namespace

SplatSums& SplatSums::operator+=(const SplatSums& other) {
  for (size_t c = 0; c < 3; ++c) {
    value[c] += other.value[c];
    square[c] += other.square[c];
  }
  return *this;
}

SplatSums SplatSums::of(const std::array<float, 3>& value) {
  SplatSums sums;
  for (size_t c = 0; c < 3; ++c) {
    const float v = std::clamp(value[c], -kMaxDeposit, kMaxDeposit);
    const double square = double{v} * double{v} / kSplatSquareUnit;  // exact
    sums.value[c] = to_fixed(v);
    sums.square[c] = to_fixed(std::min(static_cast<float>(square), kMaxDeposit));
  }
  return sums;
}

bool SplatSums::valid() const {
  return std::all_of(square.begin(), square.end(), [](const Fixed128& s) { return s.high >= 0; });
}

PartSums& PartSums::operator+=(const PartSums& other) {
  for (size_t c = 0; c < 3; ++c) value[c] += other.value[c];
  return *this;
}

PartSums PartSums::of(const std::array<float, 3>& value) {
  PartSums sums;
  for (size_t c = 0; c < 3; ++c)
    sums.value[c] = to_fixed(std::clamp(value[c], -kMaxDeposit, kMaxDeposit));
  return sums;
}

template <class PixelSums>
bool BasicSplatLayer<PixelSums>::empty() const {
  return count() == 0;
}

template <class PixelSums>
uint64_t BasicSplatLayer<PixelSums>::count() const {
  uint64_t touched = 0;
  for_each([&](uint32_t, const Sums&) { ++touched; });
  return touched;
}

template <class PixelSums>
void BasicSplatLayer<PixelSums>::deposit(std::vector<PixelSplat> splats) {
  if (!all_.empty()) {
    for (const PixelSplat& splat : splats) all_[splat.pixel] += Sums::of(splat.value);
    return;
  }
  std::sort(splats.begin(), splats.end(),
            [](const PixelSplat& a, const PixelSplat& b) { return a.pixel < b.pixel; });
  std::vector<Entry> entries;
  for (const PixelSplat& splat : splats) {
    if (entries.empty() || entries.back().pixel != splat.pixel) {
      entries.push_back({splat.pixel, Sums::of(splat.value)});
    } else {
      entries.back().sums += Sums::of(splat.value);
    }
  }
  add(std::move(entries));
}

template <class PixelSums>
void BasicSplatLayer<PixelSums>::add(std::vector<Entry> entries) {
  add(std::move(entries), kSparse);
}

template <class PixelSums>
void BasicSplatLayer<PixelSums>::add(std::vector<Entry> entries, size_t sparse) {
  if (all_.empty() && !entries.empty()) {
    if (entries_.empty()) {
      entries_ = std::move(entries);
      entries.clear();
    } else {
      std::vector<Entry> both;
      both.reserve(entries_.size() + entries.size());
      auto mine = entries_.begin();
      for (const Entry& entry : entries) {
        while (mine != entries_.end() && mine->pixel < entry.pixel) both.push_back(*mine++);
        both.push_back(entry);
        if (mine != entries_.end() && mine->pixel == entry.pixel) {
          both.back().sums += mine->sums;
          ++mine;
        }
      }
      both.insert(both.end(), mine, entries_.end());
      entries_ = std::move(both);
      entries.clear();
    }
    if (entries_.size() > static_cast<uint64_t>(region_.area()) / sparse) spread();
  }
  for (const Entry& entry : entries) all_[entry.pixel] += entry.sums;
}

template <class PixelSums>
void BasicSplatLayer<PixelSums>::spread() {
  if (!all_.empty()) return;
  all_.resize(static_cast<size_t>(region_.area()));
  for (const Entry& entry : entries_) all_[entry.pixel] = entry.sums;
  entries_ = {};
}

template <class PixelSums>
void BasicSplatLayer<PixelSums>::merge(const BasicSplatLayer& other) {
  assert(region_ == other.region_);
  if (other.all_.empty()) {
    if (!other.entries_.empty()) add(other.entries_, kSparseSum);
    return;
  }
  spread();
  for (size_t i = 0; i < all_.size(); ++i) all_[i] += other.all_[i];
}

template <class PixelSums>
typename BasicSplatLayer<PixelSums>::Sums BasicSplatLayer<PixelSums>::at(int x, int y) const {
  const auto pixel =
      static_cast<uint32_t>(int64_t{y - region_.y0} * region_.width() + (x - region_.x0));
  if (!all_.empty()) return all_[pixel];
  const auto found =
      std::lower_bound(entries_.begin(), entries_.end(), pixel,
                       [](const Entry& entry, uint32_t wanted) { return entry.pixel < wanted; });
  return found != entries_.end() && found->pixel == pixel ? found->sums : Sums{};
}

template <class PixelSums>
Status BasicSplatLayer<PixelSums>::check() const {
  bool good = true;
  for_each([&](uint32_t, const Sums& sums) { good = good && sums.valid(); });
  if (!good) return Error{"a pixel holds a negative sum of squares of splats"};
  return {};
}

template <class PixelSums>
std::string BasicSplatLayer<PixelSums>::digest() const {
  static_assert(sizeof(Sums) % sizeof(Fixed128) == 0, "the bytes that are hashed are the sums'");
  Sha256Stream hash;
  std::vector<std::byte> piece;
  for_each([&](uint32_t pixel, const Sums& sums) {
    const auto number = std::as_bytes(std::span(&pixel, 1));
    const auto numbers = std::as_bytes(std::span(&sums, 1));
    piece.insert(piece.end(), number.begin(), number.end());
    piece.insert(piece.end(), numbers.begin(), numbers.end());
    if (piece.size() < kEntriesPerPiece * sizeof(Entry)) return;
    hash.add(piece);
    piece.clear();
  });
  hash.add(piece);
  return to_hex(hash.digest());
}

template class BasicSplatLayer<SplatSums>;
template class BasicSplatLayer<PartSums>;

}  // namespace hyades::core
