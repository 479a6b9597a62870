// A file of media with measured coefficients, JSON or YAML.

#include "core/job/media_file.h"
#include "core/job/source.h"
#include "tests/fuzz/fuzz.h"

namespace hyades::fuzz {

std::vector<std::string> seeds() {
  return {"media:\n  milk: {scattering: [0.1, 0.2, 0.3], absorption: 0.01, g: 0.7, units: mm}\n",
          "{\"media\": {\"wax\": {\"scattering\": [1, 2, 3], \"absorption\": [0, 0, 1e-3]}}}",
          "milk: {preset: skim-milk}\n"};
}

bool try_input(std::string_view input) {
  core::Diagnostics diagnostics;
  (void)core::read_media_file(input, "a.media.yaml", diagnostics);
  return diagnostics.empty();
}

}  // namespace hyades::fuzz
