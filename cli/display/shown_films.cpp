#include "cli/display/shown_films.h"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>

#include "core/base/machine.h"
#include "core/film/film_part.h"

namespace hyades::cli {
namespace {

constexpr double kShare = 0.02;
/// What the first parts may take, so that something is seen at once.
constexpr double kAdvance = 0.02;  // seconds
constexpr int kPart = Viewer::kPart;

int columns_of(const core::PixelRect& window) { return (window.width() + kPart - 1) / kPart; }
int rows_of(const core::PixelRect& window) { return (window.height() + kPart - 1) / kPart; }

}  // namespace

std::string picture_name(const std::string& job, int32_t frame, bool several) {
  return several ? fmt::format("{}.{:04}", job, frame) : job;
}

ShownFilms::Pending& ShownFilms::pending_of(int32_t frame, const core::Film& film) {
  const auto [entry, fresh] = pending_.try_emplace(frame);
  // All of it at first: some may be of an earlier run.
  if (fresh) {
    const auto parts = columns_of(film.window()) * rows_of(film.window());
    entry->second.parts.assign(static_cast<size_t>(parts), true);
  }
  return entry->second;
}

void ShownFilms::grown(int32_t frame, const core::Film& film, const core::PixelRect& tile) {
  const core::MutexLock lock(mutex_);
  Pending& pending = pending_of(frame, film);
  const core::PixelRect& window = film.window();
  // With splats every pixel has a part in each.
  const core::PixelRect changed = film.layout().layers.splats ? window : tile;
  const int columns = columns_of(window);
  for (int row = (changed.y0 - window.y0) / kPart; row <= (changed.y1 - 1 - window.y0) / kPart;
       ++row) {
    for (int column = (changed.x0 - window.x0) / kPart;
         column <= (changed.x1 - 1 - window.x0) / kPart; ++column) {
      pending.parts[static_cast<size_t>(row * columns + column)] = true;
    }
  }
  show(frame, film, false);
}

void ShownFilms::complete(int32_t frame, const core::Film& film) {
  const core::MutexLock lock(mutex_);
  pending_of(frame, film);
  show(frame, film, true);
  pending_.erase(frame);
}

bool ShownFilms::may_spend() const {
  const std::chrono::duration<double> run = Clock::now() - begin_;
  return spent_ <= kAdvance + kShare * run.count();
}

void ShownFilms::show(int32_t frame, const core::Film& film, bool all) {
  Pending& pending = pending_.at(frame);
  const core::PixelRect& window = film.window();
  const int columns = columns_of(window);
  const size_t count = pending.parts.size();
  for (size_t looked = 0; looked < count && (all || may_spend()); ++looked) {
    const size_t part = pending.next++ % count;
    if (!pending.parts[part]) continue;
    // Of the processor: where others want it too, waiting for it is no work.
    const double begin = core::thread_seconds();
    if (film.layout().layers.splats) {
      pending.parts.assign(count, false);
      show_part(frame, film, window);
    } else {
      pending.parts[part] = false;
      const int x = window.x0 + static_cast<int>(part) % columns * kPart;
      const int y = window.y0 + static_cast<int>(part) / columns * kPart;
      show_part(frame, film, core::intersection(window, {x, y, x + kPart, y + kPart}));
    }
    spent_ += core::thread_seconds() - begin;
  }
}

void ShownFilms::show_part(int32_t frame, const core::Film& film, const core::PixelRect& part) {
  const core::PixelRect& window = film.window();
  viewer_.put(picture_name(job_, frame, several_), window.width(), window.height(),
              core::normalised_part(film, part), part.x0 - window.x0, part.y0 - window.y0);
}

}  // namespace hyades::cli
