// A film in a file: an EXR with a picture and exact sums.

#include "core/film/film_exr.h"
#include "tests/core/film/film_testing.h"
#include "tests/core/image/image_tools.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_files.h"
#include "tests/support/temp_folder.h"

namespace hyades::fuzz {

std::vector<std::string> seeds() {
  const core::PixelRect tile{0, 0, 5, 4};
  core::FilmFile file;
  file.info = {"job", std::string(64, 'a'), 1, 8, 6, {0, 0, 8, 6}, 64, "class", "build", {}};
  file.film = core::render(core::make_film_layout(core::kAllLayers), tile, {0, 2}, 64);
  test::TempFolder folder;
  const std::string path = folder.file("film.exr");
  if (!core::write_film_exr(path, file)) return {""};
  return {test::file_contents(path)};
}

bool try_input(std::string_view input) {
  return core::read_film_exr(exact_bytes(input), "film.exr").ok();
}

}  // namespace hyades::fuzz
