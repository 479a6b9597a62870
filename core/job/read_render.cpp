#include <fmt/format.h>

#include <array>
#include <charconv>
#include <optional>

#include "core/base/text.h"
#include "core/job/read_sections.h"

/// frames, film, sampling, integrator: what is rendered and how.
namespace hyades::core {

namespace {

constexpr int32_t kLastFrame = 9'999'999;
constexpr int64_t kMostPixels = int64_t{1} << 28;
constexpr uint32_t kMostSamples = uint32_t{1} << 24;

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

struct FilterRow {
  const char* name;
  FilterKind kind;
  float radius;  ///< default, pixels; 0: the filter has none
};

constexpr std::array<FilterRow, 6> kFilterRows = {{
    {"box", FilterKind::box, 0.5F},
    {"triangle", FilterKind::triangle, 1.0F},
    {"gaussian", FilterKind::gaussian, 1.5F},
    {"mitchell", FilterKind::mitchell, 2.0F},
    {"blackman-harris", FilterKind::blackman_harris, 1.5F},
    {"center", FilterKind::center, 0.0F},
}};

void read_filter_type(MapReader& reader, std::string_view key, FilmDesc& film) {
  std::vector<std::string> names;
  for (const FilterRow& row : kFilterRows) names.emplace_back(row.name);
  std::string name = "blackman-harris";
  reader.choice(key, name, names);
  for (const FilterRow& row : kFilterRows) {
    if (name != row.name) continue;
    film.filter = row.kind;
    film.filter_radius = row.radius;
  }
}

void read_filter(MapReader& reader, FilmDesc& film) {
  const YamlNode* node = reader.find("filter");
  if (node != nullptr && node->kind == YamlNode::Kind::scalar) {
    read_filter_type(reader, "filter", film);
    return;
  }
  reader.map("filter", "film.filter", [&](MapReader& filter) {
    read_filter_type(filter, "type", film);
    if (film.filter != FilterKind::center) {
      filter.number("radius", film.filter_radius, {0.0, 16.0, true});
    }
  });
}

void read_size(MapReader& reader, FilmDesc& film) {
  std::array<int32_t, 2> size = {film.width, film.height};
  reader.integers("size", size, 1, 65536);
  film.width = size[0];
  film.height = size[1];
  if (int64_t{film.width} * film.height > kMostPixels) {
    reader.complain(reader.find("size")->where,
                    fmt::format("a film of {} pixels, expected at most {}",
                                int64_t{film.width} * film.height, kMostPixels));
  }
}

void read_crop(MapReader& reader, FilmDesc& film) {
  const YamlNode* node = reader.find("crop");
  if (node == nullptr) return;
  std::array<int32_t, 4> edges = {0, 0, 1, 1};
  if (!reader.integers("crop", edges, 0, 65536)) return;
  const PixelRect crop{edges[0], edges[1], edges[2], edges[3]};
  if (crop.empty() || !PixelRect{0, 0, film.width, film.height}.contains(crop)) {
    reader.complain(node->where,
                    fmt::format("crop is [{}, {}, {}, {}], expected [x0, y0, x1, y1] with x0 < x1 "
                                "and y0 < y1 inside the film of {} x {}",
                                crop.x0, crop.y0, crop.x1, crop.y1, film.width, film.height));
    return;
  }
  film.crop = crop;
}

void read_path(MapReader& reader, IntegratorDesc& integrator) {
  reader.integer("max_depth", integrator.max_depth, 0, 65536);
  reader.integer("roulette_depth", integrator.roulette_depth, 0, 65536);
  reader.number("clamp", integrator.clamp, kNotNegative);
}

void read_bdpt(MapReader& reader, IntegratorDesc& integrator) {
  reader.integer("max_depth", integrator.max_depth, 0, 65536);
  reader.integer("roulette_depth", integrator.roulette_depth, 0, 65536);
  const YamlNode* node = reader.find("strategy");
  std::array<int32_t, 2> strategy = {0, 2};
  if (node != nullptr && reader.integers("strategy", strategy, 0, 65538)) {
    const auto [s, t] = strategy;
    if (t < 1 || s + t < 2 || (s == 1 && t == 1)) {
      reader.complain(node->where,
                      fmt::format("strategy is [{}, {}], expected [s, t]: how many vertices come "
                                  "from the light and from the camera, such as [0, 2], [1, 2] or "
                                  "[2, 1]",
                                  s, t));
    } else if (s + t - 2 > integrator.max_depth) {
      reader.complain(node->where,
                      fmt::format("strategy is [{}, {}], which is {} events, expected no more than "
                                  "max_depth, {}",
                                  s, t, s + t - 2, integrator.max_depth));
    }
    integrator.light_vertices = s;
    integrator.camera_vertices = t;
  }
  reader.flag("mis", integrator.mis);
  if (!integrator.mis && integrator.light_vertices < 0) {
    reader.complain(reader.find("mis")->where,
                    "mis is false without a strategy, expected [s, t] in strategy too: all of them "
                    "unweighted would add up to several times the picture");
  }
}

void read_mlt(MapReader& reader, IntegratorDesc& integrator) {
  static const std::array<std::string, 2> kOver = {"bdpt", "path"};
  reader.choice("over", integrator.over, kOver);
  reader.integer("max_depth", integrator.max_depth, 0, 65536);
  reader.integer("roulette_depth", integrator.roulette_depth, 0, 65536);
  reader.number("large_step", integrator.large_step, {0.01, 1.0});
}

const std::array<TypeRow<IntegratorDesc>, 3> kIntegrators = {{
    {"path", read_path},
    {"bdpt", read_bdpt},
    {"mlt", read_mlt},
}};

}  // namespace

void read_frames(MapReader& top, FramesDesc& frames) {
  const auto read_range = [&](MapReader& reader, std::string_view key) {
    std::string text;
    const std::string expected =
        fmt::format("a frame or range such as 7, 1-120 or 1-120x2, up to {}", kLastFrame);
    reader.text(key, text, expected);
    if (!text.empty() && !parse_range(text, frames)) {
      reader.mismatch(key, *reader.find(key), expected);
    }
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
}

void read_film(MapReader& top, FilmDesc& film) {
  top.map("film", "film", [&](MapReader& reader) {
    read_size(reader, film);
    read_crop(reader, film);
    read_filter(reader, film);
  });
}

void read_sampling(MapReader& top, SamplingDesc& sampling) {
  static const std::array<std::string, 2> kSamplers = {"sobol", "independent"};
  top.map("sampling", "sampling", [&](MapReader& reader) {
    reader.integer("samples", sampling.samples, 1, kMostSamples);
    reader.integer("seed", sampling.seed);
    std::string name = kSamplers[0];
    reader.choice("sampler", name, kSamplers);
    sampling.sampler = name == kSamplers[0] ? SamplerName::sobol : SamplerName::independent;
  });
}

void read_integrator(MapReader& top, IntegratorDesc& integrator) {
  const YamlNode* node = top.find("integrator");
  if (node != nullptr && node->kind == YamlNode::Kind::scalar) {
    YamlNode alone = empty_map();  // the short form of {type: name}
    alone.where = node->where;
    alone.map.push_back({"type", node->where, std::make_shared<YamlNode>(*node)});
    MapReader reader(top.context(), alone, "the integrator", "integrator", "integrator");
    read_by_type<IntegratorDesc>(reader, "type", "integrator", integrator, kIntegrators);
    return;
  }
  top.map("integrator", "integrator", [&](MapReader& reader) {
    read_by_type<IntegratorDesc>(reader, "type", "integrator", integrator, kIntegrators);
  });
}

}  // namespace hyades::core
