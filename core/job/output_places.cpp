#include "core/job/output_places.h"

#include <cstddef>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "core/job/film_file.h"
#include "core/job/output_path.h"

namespace hyades::core {

namespace {

constexpr size_t kBytesOfNode = 64;  ///< of a name count as one node of the job's text

/// Of places as place_of_output() tells them.
bool is_in_folder(const std::string& place, const std::string& folder) {
  return place.size() > folder.size() && place.starts_with(folder) && place[folder.size()] == '\0';
}

}  // namespace

void check_frame_marks(MapReader& reader, const SourceLocation& where, const std::string& file,
                       const FramesDesc& frames, bool video) {
  if (video) {
    if (file.find('#') == std::string::npos) return;
    reader.complain(where,
                    fmt::format("file is '{}', expected no #: a video holds all frames", file));
    return;
  }
  if (frames.first == frames.last || file.find('#') != std::string::npos) return;
  reader.complain(where, fmt::format("file is '{}', but the job has several frames: expected #### "
                                     "where the frame number goes",
                                     file));
}

void check_inside_folder(MapReader& reader, const SourceLocation& where, const std::string& file) {
  const OutputName name = output_name(file);
  if (name == OutputName::outside) {
    reader.complain(where, fmt::format("file is '{}', expected a path below the output folder "
                                       "(no '..', not absolute); --output chooses the folder",
                                       file));
  } else if (name == OutputName::reserved) {
    reader.complain(where, fmt::format("file is '{}', expected another folder: what is in .hyades "
                                       "is removed with the run's log",
                                       file));
  }
}

bool has_own_place(MapReader& reader, const SourceLocation& where, const std::string& file,
                   const Job& job) {
  const std::string film = film_file(job);
  if (job.keep_films && (same_output_path(file, film) || nested_output_paths(file, film))) {
    reader.complain(where, fmt::format("file is '{}', where keep_films puts the film, expected "
                                       "another name",
                                       file));
  }
  if (!reader.context().spend(1 + file.size() / kBytesOfNode, where)) return false;
  // Between a folder and what is in it stands nothing but what is in it, too: those that are there
  // being apart, only the neighbours may be one's own.
  auto& places = reader.context().output_places;
  std::string place = place_of_output(file);
  const auto next = places.lower_bound(place);
  if (next != places.end() && next->first == place) {
    reader.complain(where, fmt::format("file is '{}', which line {} writes already", file,
                                       next->second.where.line));
    return false;
  }
  auto other = places.end();
  if (next != places.end() && is_in_folder(next->first, place)) other = next;
  if (next != places.begin() && is_in_folder(place, std::prev(next)->first)) {
    other = std::prev(next);
  }
  if (other != places.end()) {
    reader.complain(where, fmt::format("file is '{}', which cannot stand beside '{}' of line {}: "
                                       "one would be the other's folder",
                                       file, other->second.file, other->second.where.line));
    return false;
  }
  places.emplace_hint(next, std::move(place), OutputPlace{file, where});
  return true;
}

}  // namespace hyades::core
