#pragma once

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>

namespace hyades::test {

/// Whether the case called `name` of `all`, the cases of a long test, is to run: all are, but where
/// HYADES_TEST_QUARTER (0 to 3) asks for every fourth one from there on (docs/testing.md). Throws
/// where that is something else, or no case has the name.
template <class Cases>
bool in_quarter(const Cases& all, std::string_view name) {
  const char* set = std::getenv("HYADES_TEST_QUARTER");
  const std::string quarter = set != nullptr ? set : "";
  if (quarter.empty()) return true;
  if (quarter.size() != 1 || quarter[0] < '0' || quarter[0] > '3')
    throw std::runtime_error("HYADES_TEST_QUARTER is '" + quarter + "', expected 0 to 3");
  const auto found = std::find_if(std::begin(all), std::end(all),
                                  [&](const auto& one) { return one.name == name; });
  if (found == std::end(all)) throw std::runtime_error("no case is called " + std::string(name));
  return std::distance(std::begin(all), found) % 4 == quarter[0] - '0';
}

inline constexpr const char* kOtherQuarter = "in another quarter (docs/testing.md)";

}  // namespace hyades::test
