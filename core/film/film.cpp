#include "core/film/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstddef>
#include <utility>

#include "core/base/ray.h"
#include "core/base/text.h"

namespace hyades::core {
namespace {

/// Minima are compared as integers that order like the floats, so that neither DAZ nor signed
/// zeros can make the result depend on the order of merging.
uint32_t order_key(uint32_t bits) { return (bits >> 31U) != 0 ? ~bits : bits | 0x80000000U; }

Fixed128 min_bits(float value) { return {std::bit_cast<uint32_t>(value), 0}; }

void take_minimum(Fixed128& into, const Fixed128& from) {
  if (order_key(static_cast<uint32_t>(from.low)) < order_key(static_cast<uint32_t>(into.low))) {
    into = from;
  }
}

/// Whether the bits are those of a float that is no NaN.
bool is_minimum(const Fixed128& value) {
  const auto bits = static_cast<uint32_t>(value.low);
  return value.high == 0 && value.low == bits && (bits & 0x7FFFFFFFU) <= 0x7F800000U;
}

/// The whole part of what one batch brings to a pixel, at most.
constexpr auto kMostOfBatch = static_cast<int64_t>(kMaxDeposit) + 1;

float clamp_deposit(float value) { return std::clamp(value, -kMaxDeposit, kMaxDeposit); }

std::string describe(const CoverageBox& box) {
  return fmt::format("batches {} to {} of pixels x {} to {}, y {} to {}", box.batches.first,
                     box.batches.end() - 1, box.tile.x0, box.tile.x1 - 1, box.tile.y0,
                     box.tile.y1 - 1);
}

}  // namespace

Film::Film(FilmLayout layout, PixelRect window, PixelRect region)
    : layout_(std::move(layout)),
      window_(window),
      splats_(layout_.layers.splats ? region : PixelRect{}) {
  const auto pixels = static_cast<size_t>(window_.area());
  planes_.reserve(layout_.channels.size());
  if (layout_.layers.splats) part_splats_.assign(layout_.part_count(), PartSplatLayer(region));
  for (size_t kind = 0; kind < kIdKinds; ++kind) {
    if (layout_.layers.ids[kind]) ids_[kind] = IdLayer(window_);
  }
  for (const FilmChannel& channel : layout_.channels) {
    planes_.emplace_back(pixels, channel.rule == MergeRule::min ? min_bits(kInfinity) : Fixed128{});
  }
}

size_t Film::offset(int x, int y) const {
  return static_cast<size_t>(y - window_.y0) * static_cast<size_t>(window_.width()) +
         static_cast<size_t>(x - window_.x0);
}

void Film::deposit(const PixelRect& tile, uint32_t batch, uint32_t samples,
                   std::span<const float> values) {
  const auto stride = static_cast<size_t>(layout_.deposited);
  const auto width = static_cast<size_t>(tile.width());
  assert(window_.contains(tile) && samples >= 1 && samples <= kBatchSamples);
  assert(values.size() == static_cast<size_t>(tile.area()) * stride);
  coverage_.add({tile, {batch, 1}});

  const double count = samples;
  const Fixed128 fixed_count = {0, samples};
  for (int y = tile.y0; y < tile.y1; ++y) {
    const float* const row = values.data() + static_cast<size_t>(y - tile.y0) * width * stride;
    const size_t begin = offset(tile.x0, y);
    for (size_t c = 0; c < stride; ++c) {
      Fixed128* const plane = planes_[c].data() + begin;
      if (layout_.channels[c].rule == MergeRule::sum) {
        for (size_t x = 0; x < width; ++x) {
          plane[x] += to_fixed(clamp_deposit(row[x * stride + c]));
        }
      } else {
        for (size_t x = 0; x < width; ++x) take_minimum(plane[x], min_bits(row[x * stride + c]));
      }
    }
    for (size_t c = 0; c < 3; ++c) {
      Fixed128* const plane = planes_[static_cast<size_t>(layout_.moment2) + c].data() + begin;
      for (size_t x = 0; x < width; ++x) {
        const double s = clamp_deposit(row[x * stride + c]);  // its square is exact
        plane[x] += to_fixed(clamp_deposit(static_cast<float>(s * s / count)));
      }
    }
    Fixed128* const plane = planes_[static_cast<size_t>(layout_.samples)].data() + begin;
    for (size_t x = 0; x < width; ++x) plane[x] += fixed_count;
  }
}

void Film::deposit_splats(std::vector<PixelSplat> splats) {
  assert(layout_.layers.splats);
  splats_.deposit(std::move(splats));
}

void Film::deposit_splats(size_t part, std::vector<PixelSplat> splats) {
  assert(part < part_splats_.size());
  part_splats_[part].deposit(std::move(splats));
}

Status Film::merge(const Film& other) {
  if (layout_ != other.layout_) return Error{"the films have different layers"};
  if (other.window_.empty()) return {};
  if (!window_.contains(other.window_)) return Error{"the film reaches beyond the other's window"};
  if (splats_.region() != other.splats_.region()) {
    return Error{"the films' splats belong to different parts of the frame"};
  }
  for (const CoverageBox& box : other.coverage_.boxes()) {
    if (const auto both = coverage_.overlap(box)) {
      return Error{fmt::format("both films hold {}", describe(*both))};
    }
  }

  const auto width = static_cast<size_t>(other.window_.width());
  for (size_t c = 0; c < planes_.size(); ++c) {
    const bool sums = layout_.channels[c].rule == MergeRule::sum;
    for (int y = other.window_.y0; y < other.window_.y1; ++y) {
      Fixed128* const into = planes_[c].data() + offset(other.window_.x0, y);
      const Fixed128* const from = other.planes_[c].data() + other.offset(other.window_.x0, y);
      if (sums) {
        for (size_t x = 0; x < width; ++x) into[x] += from[x];
      } else {
        for (size_t x = 0; x < width; ++x) take_minimum(into[x], from[x]);
      }
    }
  }
  splats_.merge(other.splats_);
  for (size_t i = 0; i < part_splats_.size(); ++i) part_splats_[i].merge(other.part_splats_[i]);
  for (size_t i = 0; i < kIdKinds; ++i) ids_[i].merge(other.ids_[i]);
  for (const CoverageBox& box : other.coverage_.boxes()) coverage_.add(box);
  return {};
}

void Film::erase(const PixelRect& tile) {
  const PixelRect gone = intersection(window_, tile);
  if (gone.empty()) return;
  if (layout_.layers.splats) {
    assert(gone == window_);
    splats_ = SplatLayer(splats_.region());
    for (PartSplatLayer& part : part_splats_) part = PartSplatLayer(splats_.region());
  }
  for (IdLayer& ids : ids_) ids.erase(gone);
  for (size_t c = 0; c < planes_.size(); ++c) {
    const bool sums = layout_.channels[c].rule == MergeRule::sum;
    for (int y = gone.y0; y < gone.y1; ++y) {
      Fixed128* const row = planes_[c].data() + offset(gone.x0, y);
      std::fill_n(row, gone.width(), sums ? Fixed128{} : min_bits(kInfinity));
    }
  }
  Coverage left;
  for (const CoverageBox& box : coverage_.boxes()) {
    const PixelRect& all = box.tile;
    const PixelRect cut = intersection(all, gone);
    if (cut.empty()) {
      left.add(box);
      continue;
    }
    // Above, below, left and right of what goes; an empty box adds nothing.
    left.add({{all.x0, all.y0, all.x1, cut.y0}, box.batches});
    left.add({{all.x0, cut.y1, all.x1, all.y1}, box.batches});
    left.add({{all.x0, cut.y0, cut.x0, cut.y1}, box.batches});
    left.add({{cut.x1, cut.y0, all.x1, cut.y1}, box.batches});
  }
  coverage_ = std::move(left);
}

uint64_t Film::memory() const {
  uint64_t extra = 0;
  for (const PartSplatLayer& part : part_splats_) extra += part.memory();
  for (const IdLayer& ids : ids_) extra += ids.memory();
  return static_cast<uint64_t>(window_.area()) * planes_.size() * sizeof(Fixed128) +
         splats_.memory() + extra;
}

Fixed128 Film::sum(int x, int y, int channel) const {
  return planes_[static_cast<size_t>(channel)][offset(x, y)];
}

float Film::minimum(int x, int y, int channel) const {
  return std::bit_cast<float>(static_cast<uint32_t>(sum(x, y, channel).low));
}

std::span<const Fixed128> Film::plane(int channel) const {
  return planes_[static_cast<size_t>(channel)];
}

std::span<Fixed128> Film::mutable_plane(int channel) {
  return planes_[static_cast<size_t>(channel)];
}

std::vector<uint32_t> Film::batch_counts() const {
  // Each box adds its count at four corners of a table of differences, whose prefix sums in both
  // directions are the counts. Unsigned arithmetic wraps back.
  const auto width = static_cast<size_t>(std::max(window_.width(), 0));
  const auto height = static_cast<size_t>(std::max(window_.height(), 0));
  std::vector<uint32_t> differences((width + 1) * (height + 1), 0);
  const auto at = [&](int x, int y) -> uint32_t& {
    return differences[static_cast<size_t>(y - window_.y0) * (width + 1) +
                       static_cast<size_t>(x - window_.x0)];
  };
  for (const CoverageBox& box : coverage_.boxes()) {
    at(box.tile.x0, box.tile.y0) += box.batches.count;
    at(box.tile.x1, box.tile.y0) -= box.batches.count;
    at(box.tile.x0, box.tile.y1) -= box.batches.count;
    at(box.tile.x1, box.tile.y1) += box.batches.count;
  }
  std::vector<uint32_t> counts(width * height);
  for (size_t y = 0; y < height; ++y) {
    uint32_t along_row = 0;
    for (size_t x = 0; x < width; ++x) {
      along_row += differences[y * (width + 1) + x];
      counts[y * width + x] = along_row + (y > 0 ? counts[(y - 1) * width + x] : 0);
    }
  }
  return counts;
}

Status Film::check() const {
  for (const CoverageBox& box : coverage_.boxes()) {
    if (box.tile.empty() || box.batches.count == 0 || !window_.contains(box.tile)) {
      return Error{
          fmt::format("the film claims {}, which is not inside its window", describe(box))};
    }
  }
  const std::vector<uint32_t> batches = batch_counts();
  const std::span<const Fixed128> samples = plane(layout_.samples);
  for (size_t i = 0; i < batches.size(); ++i) {
    const int64_t n = samples[i].high;
    const bool fits =
        samples[i].low == 0 && n >= int64_t{batches[i]} && n <= int64_t{kBatchSamples} * batches[i];
    if (fits) continue;
    return Error{
        fmt::format("a pixel holds {} samples in {} batches", to_double(samples[i]), batches[i])};
  }
  for (size_t c = 0; c < planes_.size(); ++c) {
    const bool minima = layout_.channels[c].rule == MergeRule::min;
    const Fixed128 nothing = minima ? min_bits(kInfinity) : Fixed128{};
    for (size_t i = 0; i < batches.size(); ++i) {
      if (batches[i] == 0 && planes_[c][i] != nothing) {
        return Error{
            fmt::format("channel {} has a value where no batch is held", layout_.channels[c].name)};
      }
      // Or honest films could not be added to it.
      const int64_t most = kMostOfBatch * int64_t{batches[i]};
      const int64_t whole = planes_[c][i].high;
      if (!minima && (whole > most || whole < -most)) {
        return Error{fmt::format("channel {} has a value beyond what {} batches add up to",
                                 layout_.channels[c].name, batches[i])};
      }
      if (minima && !is_minimum(planes_[c][i])) {
        return Error{
            fmt::format("channel {} has a value that is no float", layout_.channels[c].name)};
      }
    }
  }
  for (int c = layout_.moment2; c < layout_.moment2 + 3; ++c) {
    const std::span<const Fixed128> squares = plane(c);
    if (std::any_of(squares.begin(), squares.end(), [](const Fixed128& s) { return s.high < 0; }))
      return Error{"a sum of squares is negative"};
  }
  if (const Status ids = check_ids(); !ids) return ids;
  return check_splats();
}

Status Film::check_ids() const {
  const std::span<const Fixed128> samples = plane(layout_.samples);
  for (const IdLayer& ids : ids_) {
    if (const Status named = ids.check(); !named) return named;
    uint32_t pixel = 0;
    uint64_t met = 0;
    for (int y = ids.window().y0; y < ids.window().y1; ++y) {
      for (const IdCount& entry : ids.row(y)) {
        met = entry.pixel == pixel ? met + entry.count : entry.count;
        pixel = entry.pixel;
        if (met > static_cast<uint64_t>(samples[pixel].high))
          return Error{"a pixel holds more ids than samples"};
      }
    }
  }
  return {};
}

Status Film::check_id_room() const {
  constexpr const char* kWhat[kIdKinds] = {"object", "material"};
  const uint64_t most = id_room(window_);
  for (size_t kind = 0; kind < kIdKinds; ++kind) {
    const uint64_t memory = ids_[kind].memory();
    if (memory <= most) continue;
    return Error{fmt::format(
        "its pixels meet so many {0}s that their ids take {1}, more than the {2} that they may; "
        "expected fewer samples, a smaller aperture, or no layers crypto_{0} and {0}_id",
        kWhat[kind], format_bytes(memory), format_bytes(most))};
  }
  return {};
}

Status Film::check_splats() const {
  if (!layout_.layers.splats) return {};
  if (!splats_.region().contains(window_)) {
    return Error{"the film reaches beyond the region of its splats"};
  }
  const bool any =
      !splats_.empty() || std::any_of(part_splats_.begin(), part_splats_.end(),
                                      [](const PartSplatLayer& part) { return !part.empty(); });
  if (coverage_.boxes().empty() && any) {
    return Error{"the film has splats, but holds no batch"};
  }
  return splats_.check();
}

}  // namespace hyades::core
