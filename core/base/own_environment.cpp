#include "core/base/own_environment.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace hyades::core {
namespace {

constexpr std::array<std::string_view, 14> kPassedOn = {"PATH",
                                                        "TMPDIR",
                                                        "TZ",
                                                        "LANG",
                                                        "LANGUAGE",
                                                        "LD_LIBRARY_PATH",
                                                        "LD_PRELOAD",
                                                        "ASAN_OPTIONS",
                                                        "LSAN_OPTIONS",
                                                        "TSAN_OPTIONS",
                                                        "UBSAN_OPTIONS",
                                                        "LLVM_PROFILE_FILE",
                                                        "HYADES_FAILPOINT",
                                                        "HYADES_OIDN"};

bool is_passed_on(std::string_view variable) {
  const std::string_view name = variable.substr(0, variable.find('='));
  return name.starts_with("LC_") ||
         std::find(kPassedOn.begin(), kPassedOn.end(), name) != kPassedOn.end();
}

}  // namespace

std::vector<std::string> own_environment() {
  std::vector<std::string> kept;
  for (char** variable = environ; variable != nullptr && *variable != nullptr; ++variable) {
    if (is_passed_on(*variable)) kept.emplace_back(*variable);
  }
  return kept;
}

std::vector<char*> for_exec(std::vector<std::string>& strings) {
  std::vector<char*> pointers;
  for (std::string& text : strings) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

}  // namespace hyades::core
