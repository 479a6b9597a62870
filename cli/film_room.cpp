#include "cli/film_room.h"

#include <algorithm>

#include <fmt/format.h>

#include "coordinator/local/local_plan.h"
#include "core/base/machine.h"
#include "core/base/text.h"
#include "core/film/layout.h"
#include "core/job/layers.h"

namespace hyades::cli {

core::Status FilmRoom::check() const {
  if (film <= most) return {};
  const std::string memory =
      here > 0 ? fmt::format(" of the {} of memory here", core::format_bytes(here)) : "";
  return core::Error{
      fmt::format("film: {} x {} pixels of {} channels take {}, films may take {}{} "
                  "(--film-memory); expected a smaller size, a crop, or fewer layers",
                  window.width(), window.height(), channels, core::format_bytes(film),
                  core::format_bytes(most), memory)};
}

uint32_t FilmRoom::frames_in_flight() const {
  return static_cast<uint32_t>(std::clamp<uint64_t>(most / std::max<uint64_t>(film, 1), 1,
                                                    coordinator::LocalPlan{}.frames_in_flight));
}

FilmRoom film_room(const core::Job& job, const core::PixelRect& window, uint64_t most) {
  const core::FilmLayout layout = core::make_film_layout(core::needed_layers(job));
  FilmRoom room;
  room.window = window;
  room.channels = layout.channels.size();
  room.film = core::film_memory(layout, window, core::render_window(job.film));
  room.here = core::usable_memory();
  room.most = most > 0 ? most : core::half_of_memory();
  return room;
}

}  // namespace hyades::cli
