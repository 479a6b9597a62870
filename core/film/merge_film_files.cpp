#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "core/film/film_exr.h"

namespace hyades::core {
namespace {

std::string size_text(const FilmInfo& info) {
  return fmt::format("{} x {}", info.width, info.height);
}

std::string region_text(const PixelRect& r) {
  return fmt::format("{} x {} at {}, {}", r.width(), r.height(), r.x0, r.y0);
}

std::string or_none(const std::string& text) { return text.empty() ? "none" : text; }

/// The first thing in which films of the two cannot be of one picture.
Status check_same_picture(const FilmInfo& a, const FilmInfo& b) {
  const auto differ = [](const char* what, const std::string& x, const std::string& y) {
    return Error{fmt::format("{} differs: {} here, {} there", what, or_none(y), or_none(x))};
  };
  if (a.frame != b.frame) {
    return differ("the frame", std::to_string(a.frame), std::to_string(b.frame));
  }
  if (a.width != b.width || a.height != b.height) {
    return differ("the frame's size", size_text(a), size_text(b));
  }
  if (a.samples != b.samples) {
    return differ("the number of samples per pixel", std::to_string(a.samples),
                  std::to_string(b.samples));
  }
  if (a.crop != b.crop) return differ("the crop", region_text(a.crop), region_text(b.crop));
  if (a.render_key != b.render_key) {
    return differ("the render key (what decides the pixels)", a.render_key, b.render_key);
  }
  if (a.worker_class != b.worker_class) {
    return differ("the class of machines, whose bits may not agree", a.worker_class,
                  b.worker_class);
  }
  return {};
}

}  // namespace

Status merge_film_files(FilmFile& into, const FilmFile& from) {
  if (Status same = check_same_picture(into.info, from.info); !same) return same;
  const PixelRect& a = into.film.window();
  const PixelRect& b = from.film.window();
  if (a.contains(b) || b.empty()) return into.film.merge(from.film);

  const PixelRect both = a.empty() ? b
                                   : PixelRect{std::min(a.x0, b.x0), std::min(a.y0, b.y0),
                                               std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
  Film grown(into.film.layout(), both, into.film.splats().region());
  if (Status s = grown.merge(into.film); !s) return s;
  if (Status s = grown.merge(from.film); !s) return s;
  into.film = std::move(grown);
  return {};
}

}  // namespace hyades::core
