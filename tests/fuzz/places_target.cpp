// A file with the places of many copies of an object.

#include "core/geometry/read_places.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_files.h"

namespace hyades::fuzz {

std::vector<std::string> seeds() {
  const std::vector<core::PlaceMatrix> places(3);
  const core::Bytes bytes = core::places_bytes(places);
  return {std::string(bytes.chars(), bytes.size()),
          "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
          "property float z\nproperty float scale\nend_header\n0 0 0 1\n1 2 3 .5\n"};
}

bool try_input(std::string_view input) {
  Files files("a.ply", input);
  return core::read_places(files, "a.ply", 100'000).ok();
}

}  // namespace hyades::fuzz
