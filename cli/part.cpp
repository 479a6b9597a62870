#include "cli/part.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

namespace hyades::cli {
namespace {

constexpr uint32_t kMostTiles = 1'000'000;
/// Pixels of a part, on average.
constexpr int64_t kSmallestTile = 256;
constexpr int64_t kEdge = 64;

std::optional<uint32_t> number(std::string_view text) {
  uint32_t value = 0;
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || failed != std::errc() || end != text.data() + text.size()) {
    return std::nullopt;
  }
  return value;
}

/// Where to cut a length that begins at `origin`, so that `part` of `parts` lie before.
int32_t cut(int64_t origin, int64_t length, int64_t part, int64_t parts) {
  const int64_t even = std::clamp<int64_t>((2 * length * part + parts) / (2 * parts), 1,
                                           std::max<int64_t>(length - 1, 1));
  const int64_t edge = (origin + even + kEdge / 2) / kEdge * kEdge - origin;
  const int64_t off = edge > even ? edge - even : even - edge;
  return static_cast<int32_t>(8 * off <= std::min(even, length - even) ? edge : even);
}

}  // namespace

core::Result<SamplesOption> parse_samples(const std::string& text) {
  const core::Error wrong{text +
                          ": expected 1 to 16777216, or samples such as 0-31 or 0-31/256 (of "
                          "256)"};
  SamplesOption option;
  std::string_view rest = text;
  const size_t dash = rest.find('-');
  if (dash == std::string_view::npos) {
    const auto count = number(rest);
    if (!count || *count < 1 || *count > kMostSamples) return wrong;
    option.of = *count;
    return option;
  }
  if (const size_t slash = rest.find('/'); slash != std::string_view::npos) {
    const auto of = number(rest.substr(slash + 1));
    if (!of || *of < 1 || *of > kMostSamples) return wrong;
    option.of = *of;
    rest = rest.substr(0, slash);
  }
  const auto first = number(rest.substr(0, dash));
  const auto last = number(rest.substr(dash + 1));
  if (!first || !last || *last < *first || *last >= kMostSamples) return wrong;
  option.range = SampleRange{*first, *last};
  return option;
}

core::Result<core::BatchRange> batches_of(const SampleRange& range, uint32_t samples) {
  const std::string what = fmt::format("--samples {}-{}", range.first, range.last);
  if (range.last >= samples) {
    return core::Error{
        fmt::format("{}: a pixel has {} samples, expected at most {}", what, samples, samples - 1)};
  }
  const uint32_t end = range.last + 1;
  const bool whole =
      range.first % core::kBatchSamples == 0 && (end % core::kBatchSamples == 0 || end == samples);
  if (!whole) {
    const uint32_t first = range.first / core::kBatchSamples * core::kBatchSamples;
    const uint32_t last =
        std::min(range.last / core::kBatchSamples * core::kBatchSamples + core::kBatchSamples,
                 samples) -
        1;
    return core::Error{
        fmt::format("{}: films hold whole batches of {} samples, expected {}-{} or the like", what,
                    core::kBatchSamples, first, last)};
  }
  return core::BatchRange{range.first / core::kBatchSamples,
                          core::batch_count(end) - range.first / core::kBatchSamples};
}

core::Result<TileOption> parse_tile(const std::string& text) {
  const std::string_view words = text;
  const size_t slash = words.find('/');
  if (slash != std::string_view::npos) {
    const auto index = number(words.substr(0, slash));
    const auto count = number(words.substr(slash + 1));
    if (index && count && *index >= 1 && *index <= *count && *count <= kMostTiles) {
      return TileOption{*index, *count};
    }
  }
  return core::Error{text + ": expected a part such as 2/3, from 1/3 to 3/3"};
}

core::Result<core::PixelRect> tile_of(const core::PixelRect& whole, const TileOption& option) {
  const int64_t most = std::max<int64_t>(whole.area() / kSmallestTile, 1);
  if (option.count > most) {
    return core::Error{fmt::format("--tile {}/{}: {} x {} pixels have at most {} parts",
                                   option.index, option.count, whole.width(), whole.height(),
                                   most)};
  }
  core::PixelRect tile = whole;
  uint32_t index = option.index - 1;
  for (uint32_t count = option.count; count > 1;) {
    const uint32_t before = count / 2;
    const bool wide = tile.width() >= tile.height();
    const int32_t at = wide ? cut(tile.x0, tile.width(), before, count)
                            : cut(tile.y0, tile.height(), before, count);
    if (index < before) {
      (wide ? tile.x1 : tile.y1) = (wide ? tile.x0 : tile.y0) + at;
      count = before;
    } else {
      (wide ? tile.x0 : tile.y0) += at;
      index -= before;
      count -= before;
    }
  }
  return tile;
}

}  // namespace hyades::cli
