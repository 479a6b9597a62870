#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "core/base/text.h"
#include "core/film/noise.h"
#include "core/job/read_sections.h"

/// frames, film, sampling, render, integrator: what is rendered and how.
namespace hyades::core {

namespace {

constexpr int32_t kLastFrame = 9'999'999;
/// Samples that a pixel gets at most where a noise ends them and nothing else is said.
constexpr uint32_t kNoiseSamples = 4096;
/// Before two batches are there nothing is known of the noise.
constexpr uint32_t kFirstJudged = 2 * kBatchSamples;
constexpr int64_t kMostPixels = int64_t{1} << 28;

/// Reads the digits at the front of `text` and removes them.
std::optional<int32_t> take_number(std::string_view& text) {
  int32_t value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc{} || result.ptr == text.data() || text[0] == '-') return std::nullopt;
  text.remove_prefix(static_cast<size_t>(result.ptr - text.data()));
  return value;
}

/// "7", "1-120", "1-120x2".
bool parse_range(std::string_view text, FramesDesc& frames) {
  const auto first = take_number(text);
  if (!first) return false;
  std::optional<int32_t> last = first;
  std::optional<int32_t> step = 1;
  if (text.starts_with('-')) {
    text.remove_prefix(1);
    last = take_number(text);
    if (text.starts_with('x')) {
      text.remove_prefix(1);
      step = take_number(text);
    }
  }
  if (!text.empty() || !last || !step || *last < *first || *step < 1) return false;
  if (*last > kLastFrame) return false;
  frames.first = *first;
  frames.last = *last;
  frames.step = *step;
  return true;
}

/// "1-5" of "5-1"; empty where the text is no range whose last frame comes first.
std::string turned_round(const std::string& text) {
  const size_t dash = text.find('-', 1);
  if (dash == std::string::npos) return "";
  const size_t end = std::min(text.find('x'), text.size());
  if (end <= dash) return "";
  const std::string turned =
      text.substr(dash + 1, end - dash - 1) + "-" + text.substr(0, dash) + text.substr(end);
  FramesDesc unused;
  return parse_range(turned, unused) ? turned : "";
}

}  // namespace

void read_frames(MapReader& top, FramesDesc& frames) {
  const auto read_range = [&](MapReader& reader, std::string_view key) {
    std::string text;
    const std::string expected =
        fmt::format("a frame or range such as 7, 1-120 or 1-120x2, up to {}", kLastFrame);
    reader.text(key, text, expected);
    if (reader.listing()) reader.tell(key, {.takes = "frames", .start = "\"1\""});
    if (text.empty() || parse_range(text, frames)) return;
    const std::string turned = turned_round(text);
    reader.mismatch(key, *reader.find(key),
                    turned.empty() ? expected : "the first frame first: " + turned);
  };
  const YamlNode* node = top.find("frames");
  if (node != nullptr && node->kind == YamlNode::Kind::scalar) {
    read_range(top, "frames");
    return;
  }
  top.map("frames", "frames", [&](MapReader& reader) {
    read_range(reader, "range");
    reader.number("fps", frames.fps, {0.0, 1e6, true});
    reader.number("shutter", frames.shutter, kUnitInterval);
  });
  if (top.listing()) top.tell("frames", {.takes = "frames or map", .below = "frames"});
}

void MapReader::integers(std::string_view key, const char* /*a_line*/, int32_t& a,
                         const char* /*b_line*/, int32_t& b, int64_t low, int64_t high) {
  std::array<int32_t, 2> both = {a, b};
  const bool read = integers(key, both, low, high);
  if (a < low) forget_start(key);
  if (!read) return;
  a = both[0];
  b = both[1];
}

void MapReader::crop(std::string_view key, FilmDesc& film) {
  std::array<int32_t, 4> edges = {0, 0, 1, 1};
  const bool read = integers(key, edges, 0, 65536);
  forget_start(key);
  if (!read) return;
  const PixelRect crop{edges[0], edges[1], edges[2], edges[3]};
  if (crop.empty() || !PixelRect{0, 0, film.width, film.height}.contains(crop)) {
    return complain(where_of(key),
                    fmt::format("crop is [{}, {}, {}, {}], expected [x0, y0, x1, y1] with x0 < x1 "
                                "and y0 < y1 inside the film of {} x {}",
                                crop.x0, crop.y0, crop.x1, crop.y1, film.width, film.height));
  }
  film.crop = crop;
}

void check_keys(MapReader& reader, FilmDesc& film) {
  if (int64_t{film.width} * film.height <= kMostPixels) return;
  reader.complain(reader.where_of("size"),
                  fmt::format("a film of {} pixels, expected at most {}",
                              int64_t{film.width} * film.height, kMostPixels));
}

void check_keys(MapReader& reader, SamplingDesc& sampling) {
  if (sampling.noise <= 0.0F) {
    if (!reader.has("min_samples")) return;
    return reader.complain(reader.where_of("min_samples"),
                           "min_samples without a noise to stop at, expected noise too: without it "
                           "every pixel gets all samples");
  }
  if (!reader.has("samples")) sampling.samples = kNoiseSamples;
  const NoiseAim aim{sampling.noise, 0.0F, sampling.min_samples};
  if (make_noise_threshold(aim, sampling.samples).adaptive()) return;
  reader.complain(
      reader.where_of("noise"),
      fmt::format("noise cannot stop {} samples: tiles are judged for the first time "
                  "after {} (min_samples, at least {}); expected more samples",
                  sampling.samples, std::max(sampling.min_samples, kFirstJudged), kFirstJudged));
}

void check_keys(MapReader& reader, IntegratorDesc& integrator) {
  const int32_t s = integrator.light_vertices;
  const int32_t t = integrator.camera_vertices;
  if (!integrator.mis && s < 0) {
    reader.complain(reader.where_of("mis"),
                    "mis is false without a strategy, expected [s, t] in strategy too: all of them "
                    "unweighted would add up to several times the picture");
  }
  if (s < 0) return;
  if (t < 1 || s + t < 2 || (s == 1 && t == 1)) {
    reader.complain(reader.where_of("strategy"),
                    fmt::format("strategy is [{}, {}], expected [s, t]: how many vertices come "
                                "from the light and from the camera, such as [0, 2], [1, 2] or "
                                "[2, 1]",
                                s, t));
  } else if (s + t - 2 > integrator.max_depth) {
    reader.complain(reader.where_of("strategy"),
                    fmt::format("strategy is [{}, {}], which is {} events, expected no more than "
                                "max_depth, {}",
                                s, t, s + t - 2, integrator.max_depth));
  }
}

void read_film(MapReader& top, FilmDesc& film) { top.map("film", "film", film); }

void read_sampling(MapReader& top, SamplingDesc& sampling) {
  top.map("sampling", "sampling", sampling);
}

void read_render(MapReader& top, RenderDesc& render) { top.map("render", "render", render); }

void read_integrator(MapReader& top, IntegratorDesc& integrator) {
  const YamlNode* node = top.find("integrator");
  if (node != nullptr && node->kind == YamlNode::Kind::scalar) {
    YamlNode alone = empty_map();  // the short form of {type: name}
    alone.where = node->where;
    alone.map.push_back({"type", node->where, std::make_shared<YamlNode>(*node)});
    MapReader reader(top.context(), alone, "the integrator", "integrator", "integrator");
    return read_typed(reader, "integrator", integrator, kIntegratorTypes);
  }
  top.map("integrator", "integrator", [&](MapReader& reader) {
    read_typed(reader, "integrator", integrator, kIntegratorTypes);
  });
}

}  // namespace hyades::core
