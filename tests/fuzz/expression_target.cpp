// What stands behind the '=' of a value in a job; what compiles is evaluated.

#include "core/job/expression.h"
#include "tests/fuzz/fuzz.h"

namespace hyades::fuzz {

std::vector<std::string> seeds() {
  return {"0.5 * t", "3 * cos(t) + frame / 2", "t > 1 ? sin(2 * pi * t) : t ^ 2",
          "min(max(t, 0.1), 3) || frame == 4 && 1", "-(1e-3 + 2.5E2)"};
}

bool try_input(std::string_view input) {
  const auto compiled = core::compile_expression(std::string(input));
  if (!compiled) return false;
  for (const double frame : {1.0, 24.5, -1e9}) (void)(*compiled)->evaluate({frame / 24.0, frame});
  return true;
}

}  // namespace hyades::fuzz
