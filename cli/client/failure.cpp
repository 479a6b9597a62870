#include "cli/client/failure.h"

#include <cstdio>

#include "cli/printable.h"

namespace hyades::cli {

int report(const char* command, const Failure& failure) {
  std::string shown = printable(failure.message);
  for (size_t i = 0; failure.lines && i < shown.size(); ++i) {
    if (failure.message[i] == '\n') shown[i] = '\n';
  }
  std::fprintf(stderr, "hyades %s: %s\n", command, shown.c_str());
  return failure.code;
}

}  // namespace hyades::cli
