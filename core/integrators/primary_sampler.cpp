#include "core/integrators/primary_sampler.h"

#include <cmath>
#include <cstddef>

#include "core/base/elementary.h"
#include "core/base/hash.h"
#include "core/samplers/sample_key.h"

namespace hyades::core {
namespace {

constexpr float kBelowOne = 0x1.fffffep-1F;

/// `x` brought into [0, 1) by whole numbers.
float wrapped(float x) {
  const float inside = x - std::floor(x);
  return inside < kBelowOne ? inside : kBelowOne;
}

}  // namespace

float NumberStream::next() {
  return static_cast<float>(mix64(key_ + kGoldenGamma * ++count_) >> 40) * 0x1p-24F;
}

float NumberStream::next_normal() {
  const float radius = std::sqrt(-2.0F * log1p(-next()));  // Box and Muller 1958
  return radius * cos(2.0F * kPi * next());
}

void PrimarySampler::mutate(bool large, float sigma) {
  ++now_;
  old_large_ = last_large_;
  if (large) last_large_ = now_;
  sigma_ = sigma;
  changed_.clear();
  dimension_ = 0;
}

void PrimarySampler::accept() { changed_.clear(); }

void PrimarySampler::reject() {
  for (const uint32_t i : changed_) {
    coordinates_[i].value = coordinates_[i].old_value;
    coordinates_[i].time = coordinates_[i].old_time;
  }
  changed_.clear();
  last_large_ = old_large_;
  --now_;
}

Vec2 PrimarySampler::next_2d() {
  const uint32_t even = dimension_ + (dimension_ & 1);
  dimension_ = even + 2;
  const float x = value(even);
  return {x, value(even + 1)};
}

Vec4 PrimarySampler::next_4d() {
  const uint32_t first = (dimension_ + 3) & ~3U;
  dimension_ = first + 4;
  const float x = value(first);
  const float y = value(first + 1);
  const float z = value(first + 2);
  return {x, y, z, value(first + 3)};
}

float PrimarySampler::value(uint32_t dimension) {
  Coordinate& c = find(dimension);
  if (c.time == now_) return c.value;
  // What a rejected large step would have made it is gone: only accepted ones count before now.
  if (c.time < old_large_) {
    c.value = stream_.next();
    c.time = old_large_;
    if (c.time == now_) return c.value;
  }
  changed_.push_back(static_cast<uint32_t>(&c - coordinates_.data()));
  c.old_value = c.value;
  c.old_time = c.time;
  if (last_large_ == now_) {
    c.value = stream_.next();
  } else {
    const auto steps = static_cast<float>(now_ - c.time);
    c.value = wrapped(c.value + sigma_ * std::sqrt(steps) * stream_.next_normal());
  }
  c.time = now_;
  return c.value;
}

PrimarySampler::Coordinate& PrimarySampler::find(uint32_t dimension) {
  if (2 * coordinates_.size() >= table_.size()) grow();
  const size_t mask = table_.size() - 1;
  size_t slot = static_cast<size_t>(mix64(dimension)) & mask;
  while (table_[slot] != 0) {
    Coordinate& c = coordinates_[table_[slot] - 1];
    if (c.dimension == dimension) return c;
    slot = (slot + 1) & mask;
  }
  // Its state since the last large step that was accepted.
  coordinates_.push_back({dimension, stream_.next(), old_large_, 0.0F, 0});
  table_[slot] = static_cast<uint32_t>(coordinates_.size());
  return coordinates_.back();
}

void PrimarySampler::grow() {
  table_.assign(table_.empty() ? 256 : 2 * table_.size(), 0);
  const size_t mask = table_.size() - 1;
  for (size_t i = 0; i < coordinates_.size(); ++i) {
    size_t slot = static_cast<size_t>(mix64(coordinates_[i].dimension)) & mask;
    while (table_[slot] != 0) slot = (slot + 1) & mask;
    table_[slot] = static_cast<uint32_t>(i + 1);
  }
}

}  // namespace hyades::core
