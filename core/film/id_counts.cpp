#include "core/film/id_counts.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <iterator>
#include <set>
#include <tuple>
#include <utility>

#include "core/base/hash.h"

namespace hyades::core {
namespace {

bool before(const IdCount& a, const IdCount& b) {
  return std::tie(a.pixel, a.id) < std::tie(b.pixel, b.id);
}

bool same_place(const IdCount& a, const IdCount& b) { return a.pixel == b.pixel && a.id == b.id; }

/// Adds up neighbours of one place.
void fold(std::vector<IdCount>& sorted) {
  size_t kept = 0;
  for (const IdCount& entry : sorted) {
    if (kept > 0 && same_place(sorted[kept - 1], entry)) {
      sorted[kept - 1].count += entry.count;
    } else {
      sorted[kept++] = entry;
    }
  }
  sorted.resize(kept);
  if (sorted.capacity() > kept + kept / 4) sorted.shrink_to_fit();
}

/// What a name takes besides its letters.
constexpr uint64_t kNameOverhead = 96;

}  // namespace

uint32_t id_of(const std::string& name) {
  const uint32_t hash = murmur3(name);
  const uint32_t exponent = hash >> 23U & 0xFFU;
  return exponent == 0 || exponent == 0xFF ? hash ^ (1U << 23U) : hash;
}

IdLayer::IdLayer(PixelRect window)
    : window_(window), rows_(static_cast<size_t>(std::max(window.height(), 0))) {}

void IdLayer::add_row(std::vector<IdCount>& into, std::span<const IdCount> from) const {
  if (from.empty()) return;
  std::vector<IdCount> both;
  both.reserve(into.size() + from.size());
  std::merge(into.begin(), into.end(), from.begin(), from.end(), std::back_inserter(both), before);
  fold(both);
  into = std::move(both);
}

void IdLayer::deposit(std::vector<IdCount> counts) {
  std::sort(counts.begin(), counts.end(), before);
  fold(counts);
  const auto width = static_cast<uint32_t>(window_.width());
  for (auto i = counts.begin(); i != counts.end();) {
    const uint32_t row = i->pixel / width;
    const auto end = std::find_if(i, counts.end(),
                                  [&](const IdCount& entry) { return entry.pixel / width != row; });
    add_row(rows_[row], {i, end});
    i = end;
  }
}

void IdLayer::name(uint32_t id, const std::string& name) {
  if (id == kNothing) return;
  const auto [known, is_new] = names_.emplace(id, name);
  if (is_new) name_bytes_ += name.size();
  if (is_new || known->second <= name) return;
  name_bytes_ += name.size() - known->second.size();  // wraps back where it is less
  known->second = name;
}

void IdLayer::merge(const IdLayer& other) {
  assert(window_.contains(other.window_) || other.window_.empty());
  std::vector<IdCount> moved;
  for (int y = other.window_.y0; y < other.window_.y1; ++y) {
    const std::span<const IdCount> from = other.row(y);
    moved.assign(from.begin(), from.end());
    const int64_t begin = int64_t{y - other.window_.y0} * other.window_.width();
    const int64_t here =
        int64_t{y - window_.y0} * window_.width() + (other.window_.x0 - window_.x0);
    for (IdCount& entry : moved) entry.pixel = static_cast<uint32_t>(entry.pixel - begin + here);
    add_row(rows_[static_cast<size_t>(y - window_.y0)], moved);
  }
  for (const auto& [id, text] : other.names_) name(id, text);
}

void IdLayer::erase(const PixelRect& tile) {
  const PixelRect gone = intersection(window_, tile);
  const auto width = static_cast<uint32_t>(std::max(window_.width(), 0));
  for (int y = gone.y0; y < gone.y1; ++y) {
    std::erase_if(rows_[static_cast<size_t>(y - window_.y0)], [&](const IdCount& entry) {
      const int x = window_.x0 + static_cast<int>(entry.pixel % width);
      return x >= gone.x0 && x < gone.x1;
    });
  }
  std::set<uint32_t> left;
  for (const auto& row : rows_) {
    for (const IdCount& entry : row) left.insert(entry.id);
  }
  std::erase_if(names_, [&](const auto& named) {
    if (left.contains(named.first)) return false;
    name_bytes_ -= named.second.size();
    return true;
  });
}

std::span<const IdCount> IdLayer::row(int y) const {
  return rows_[static_cast<size_t>(y - window_.y0)];
}

std::span<const IdCount> IdLayer::at(int x, int y) const {
  const auto pixel =
      static_cast<uint32_t>(int64_t{y - window_.y0} * window_.width() + (x - window_.x0));
  const std::vector<IdCount>& row = rows_[static_cast<size_t>(y - window_.y0)];
  const auto begin = std::lower_bound(row.begin(), row.end(), IdCount{pixel, 0, 0}, before);
  auto end = begin;
  while (end != row.end() && end->pixel == pixel) ++end;
  return {begin, end};
}

uint64_t IdLayer::count() const {
  uint64_t entries = 0;
  for (const auto& row : rows_) entries += row.size();
  return entries;
}

uint64_t IdLayer::memory() const {
  return count() * sizeof(IdCount) + names_.size() * kNameOverhead + name_bytes_;
}

bool IdLayer::add_sorted(std::span<const IdCount> counts) {
  const auto pixels = static_cast<uint64_t>(window_.area());
  const auto width = static_cast<uint32_t>(std::max(window_.width(), 1));
  for (size_t i = 0; i < counts.size(); ++i) {
    if (counts[i].pixel >= pixels || counts[i].count == 0) return false;
    if (i > 0 && !before(counts[i - 1], counts[i])) return false;
    rows_[counts[i].pixel / width].push_back(counts[i]);
  }
  return true;
}

Status IdLayer::check() const {
  std::vector<uint32_t> named;
  named.reserve(names_.size());
  for (const auto& [id, text] : names_) named.push_back(id);
  std::vector<bool> met(named.size());
  for (const auto& row : rows_) {
    for (const IdCount& entry : row) {
      if (entry.id == kNothing) continue;
      const auto at = std::lower_bound(named.begin(), named.end(), entry.id);
      if (at == named.end() || *at != entry.id) return Error{"a pixel holds an id without a name"};
      met[static_cast<size_t>(at - named.begin())] = true;
    }
  }
  if (std::find(met.begin(), met.end(), false) != met.end())
    return Error{"it names an id that no pixel holds"};
  return {};
}

std::string IdLayer::digest() const {
  Sha256Stream hash;
  for (const auto& row : rows_) hash.add(std::as_bytes(std::span(row)));
  for (const auto& [id, text] : names_) {
    hash.add(std::as_bytes(std::span(&id, 1)));
    hash.add(std::as_bytes(std::span(text.c_str(), text.size() + 1)));
  }
  return to_hex(hash.digest());
}

}  // namespace hyades::core
