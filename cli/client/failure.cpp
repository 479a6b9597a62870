#include "cli/client/failure.h"

#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>

#include "core/base/printable.h"

namespace hyades::cli {

int report(const char* command, const Failure& failure) {
  std::string shown;
  std::string_view rest = failure.message;
  while (failure.lines && rest.find('\n') != std::string_view::npos) {
    const size_t end = rest.find('\n');
    shown += core::printable(rest.substr(0, end)) + "\n";
    rest.remove_prefix(end + 1);
  }
  shown += core::printable(rest);
  std::fprintf(stderr, "hyades %s: %s\n", command, shown.c_str());
  return failure.code;
}

}  // namespace hyades::cli
