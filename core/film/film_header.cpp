#include "core/film/film_header.h"

#include <fmt/format.h>

#include <charconv>
#include <cstddef>
#include <limits>
#include <system_error>
#include <utility>
#include <vector>

namespace hyades::core {
namespace {

constexpr int kNamedLayers = 3;  ///< from this version on layers are called by their names
constexpr const char* kIdWords[kIdKinds] = {"object", "material"};
constexpr std::string_view kTitle = "hyades film ";
constexpr int32_t kMaxSide = 1 << 20;

std::string rect_text(const PixelRect& r) {
  return fmt::format("{} {} {} {}", r.x0, r.y0, r.x1, r.y1);
}

/// Names may hold anything; a line holds no line breaks.
std::string escape(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\') {
      out += "\\\\";
    } else if (c == '\n') {
      out += "\\n";
    } else {
      out += c;
    }
  }
  return out;
}

std::string unescape(std::string_view text) {
  std::string out;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\\' && i + 1 < text.size()) {
      ++i;
      out += text[i] == 'n' ? '\n' : text[i];
    } else {
      out += text[i];
    }
  }
  return out;
}

/// Reads lines "key value" in a fixed order; after a line that is not as expected all is empty.
class Lines {
 public:
  explicit Lines(std::string_view text) : left_(text) {}

  bool next_is(std::string_view key) const {
    return ok_ && left_.size() > key.size() && left_.starts_with(key) && left_[key.size()] == ' ';
  }

  std::string_view value(std::string_view key) {
    const size_t end = left_.find('\n');
    if (!next_is(key) || end == std::string_view::npos) {
      ok_ = false;
      return {};
    }
    const std::string_view value = left_.substr(key.size() + 1, end - key.size() - 1);
    left_ = left_.substr(end + 1);
    return value;
  }

  /// Integers between single spaces.
  template <class... Numbers>
  void numbers(std::string_view key, Numbers&... into) {
    std::string_view text = value(key);
    const auto one = [&](auto& number) {
      const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
      ok_ = ok_ && error == std::errc();
      text.remove_prefix(ok_ ? static_cast<size_t>(stop - text.data()) : 0);
      if (ok_ && text.starts_with(' ')) text.remove_prefix(1);
    };
    (one(into), ...);
    ok_ = ok_ && text.empty();
  }

  void rect(std::string_view key, PixelRect& r) { numbers(key, r.x0, r.y0, r.x1, r.y1); }

  bool at_end() const { return ok_ && left_.empty(); }

 private:
  std::string_view left_;
  bool ok_ = true;
};

bool inside_range(const PixelRect& r) {
  for (const int32_t side : {r.x0, r.y0, r.x1, r.y1}) {
    if (side < -kMaxSide || side > kMaxSide) return false;
  }
  return true;
}

}  // namespace

std::string write_film_header(const FilmFile& file) {
  const FilmInfo& info = file.info;
  const LayerSet& layers = file.film.layout().layers;
  const int version = film_version(layers);
  std::string text = fmt::format("{}{}\n", kTitle, version);
  text += fmt::format("job {}\nkey {}\nframe {}\nsize {} {}\ncrop {}\nsamples {}\n",
                      escape(info.job_name), escape(info.render_key), info.frame, info.width,
                      info.height, rect_text(info.crop), info.samples);
  const NoiseAim& aim = info.aim;
  if (aim.noise > 0) {
    text += fmt::format("noise {} {} {}\n", aim.noise, aim.exposure, aim.min_samples);
  }
  text += fmt::format("class {}\nbuild {}\n", escape(info.worker_class), escape(info.build));
  if (version < kNamedLayers) {
    text += fmt::format("layers {} {} {}{}\n", int{layers.depth}, int{layers.albedo},
                        int{layers.normal}, layers.splats ? " 1" : "");
  } else {
    text += fmt::format("layers {}\n", layers_text(layers));
  }
  text += fmt::format("window {}\n", rect_text(file.film.window()));
  for (const IdKind kind : {IdKind::object, IdKind::material}) {
    for (const auto& [id, name] : file.film.ids(kind).names())
      text += fmt::format("{} {} {}\n", kIdWords[static_cast<size_t>(kind)], id, escape(name));
  }
  for (const CoverageBox& box : file.film.coverage().canonical()) {
    text +=
        fmt::format("holds {} {} {}\n", rect_text(box.tile), box.batches.first, box.batches.count);
  }
  return text;
}

Result<FilmHeader> parse_film_header(std::string_view text) {
  if (!text.starts_with(kTitle)) return Error{"its film header is damaged"};
  text.remove_prefix(kTitle.size() - 1);
  Lines lines(text);
  int version = 0;
  lines.numbers("", version);
  if (version > kFilmFileVersion) {
    return Error{
        fmt::format("it was written by a newer version of Hyades (film format {}; this "
                    "build knows {})",
                    version, kFilmFileVersion)};
  }
  FilmHeader header;
  FilmInfo& info = header.info;
  info.job_name = unescape(lines.value("job"));
  info.render_key = unescape(lines.value("key"));
  lines.numbers("frame", info.frame);
  lines.numbers("size", info.width, info.height);
  lines.rect("crop", info.crop);
  lines.numbers("samples", info.samples);
  NoiseAim& aim = info.aim;
  if (lines.next_is("noise")) lines.numbers("noise", aim.noise, aim.exposure, aim.min_samples);
  info.worker_class = unescape(lines.value("class"));
  info.build = unescape(lines.value("build"));
  if (version < kNamedLayers) {
    int depth = 0;
    int albedo = 0;
    int normal = 0;
    int splats = 0;
    if (version > 1) {
      lines.numbers("layers", depth, albedo, normal, splats);
    } else {
      lines.numbers("layers", depth, albedo, normal);
    }
    header.layers = {depth != 0, albedo != 0, normal != 0, splats != 0};
  } else {
    Result<LayerSet> layers = parse_layers(lines.value("layers"));
    if (!layers) return layers.error();
    header.layers = std::move(*layers);
  }
  lines.rect("window", header.window);
  for (size_t kind = 0; kind < kIdKinds; ++kind) {
    while (lines.next_is(kIdWords[kind])) {
      std::string_view named = lines.value(kIdWords[kind]);
      uint32_t id = 0;
      const auto [stop, error] = std::from_chars(named.data(), named.data() + named.size(), id);
      named.remove_prefix(static_cast<size_t>(stop - named.data()));
      if (error != std::errc() || !named.starts_with(' '))
        return Error{"its film header is damaged"};
      header.names[kind].emplace(id, unescape(named.substr(1)));
    }
  }
  std::vector<CoverageBox> boxes;
  while (lines.next_is("holds")) {
    CoverageBox box;
    PixelRect& r = box.tile;
    lines.numbers("holds", r.x0, r.y0, r.x1, r.y1, box.batches.first, box.batches.count);
    boxes.push_back(box);
  }
  if (!lines.at_end() || version < 1) return Error{"its film header is damaged"};

  if (const Status fits = check_film_frame(info, header.window); !fits) return fits.error();
  for (const CoverageBox& box : boxes) {
    if (!header.window.contains(box.tile)) {
      return Error{fmt::format("it claims pixels {}, outside its window {}", rect_text(box.tile),
                               rect_text(header.window))};
    }
  }
  Result<Coverage> coverage = Coverage::from_canonical(boxes);
  if (!coverage) return coverage.error().in("its coverage is damaged");
  header.coverage = std::move(*coverage);
  return header;
}

Status check_film_frame(const FilmInfo& info, const PixelRect& window) {
  const PixelRect frame{0, 0, info.width, info.height};
  if (frame.empty() || window.empty() || !inside_range(frame) || !inside_range(window) ||
      !inside_range(info.crop)) {
    return Error{fmt::format("its frame ({} x {} pixels) or its window ({}) is empty or absurd",
                             info.width, info.height, rect_text(window))};
  }
  if (!frame.contains(info.crop) || !info.crop.contains(window)) {
    return Error{fmt::format("its window ({}) is not inside the crop ({}) of the frame ({} x {})",
                             rect_text(window), rect_text(info.crop), info.width, info.height)};
  }
  return {};
}

}  // namespace hyades::core
