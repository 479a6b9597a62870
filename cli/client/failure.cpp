#include "cli/client/failure.h"

#include <cstdio>
#include <string>

#include "core/base/printable.h"

namespace hyades::cli {

int report(const char* command, const Failure& failure) {
  const std::string shown =
      failure.lines ? core::printable_lines(failure.message) : core::printable(failure.message);
  std::fprintf(stderr, "hyades %s: %s\n", command, shown.c_str());
  return failure.code;
}

}  // namespace hyades::cli
