#include "core/job/output_places.h"

#include <fmt/format.h>

#include "core/job/film_file.h"
#include "core/job/output_path.h"

namespace hyades::core {

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
  const auto collides = [&](const std::string& other, const SourceLocation& of) {
    if (same_output_path(other, file)) {
      reader.complain(where,
                      fmt::format("file is '{}', which line {} writes already", file, of.line));
      return true;
    }
    if (nested_output_paths(other, file)) {
      reader.complain(where, fmt::format("file is '{}', which cannot stand beside '{}' of line {}: "
                                         "one would be the other's folder",
                                         file, other, of.line));
      return true;
    }
    return false;
  };
  const std::string film = film_file(job);
  if (job.keep_films && (same_output_path(file, film) || nested_output_paths(file, film))) {
    reader.complain(where, fmt::format("file is '{}', where keep_films puts the film, expected "
                                       "another name",
                                       file));
  }
  for (const OutputDesc& other : job.outputs) {
    if (collides(other.file, other.where)) return false;
  }
  for (const VideoDesc& other : job.videos) {
    if (collides(other.file, other.where)) return false;
  }
  return true;
}

}  // namespace hyades::core
