#include "cli/client/failure.h"

#include <cstdio>

namespace hyades::cli {

int report(const char* command, const Failure& failure) {
  std::fprintf(stderr, "hyades %s: %s\n", command, failure.message.c_str());
  return failure.code;
}

}  // namespace hyades::cli
