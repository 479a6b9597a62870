#pragma once

#include <cstdlib>
#include <string_view>

#include "core/base/hash.h"

namespace hyades::test {

/// Whether the case called `name` of a long test is to run: all are, but where HYADES_TEST_TURN
/// (0..3) asks for a quarter (docs/testing.md).
inline bool in_turn(std::string_view name) {
  const char* turn = std::getenv("HYADES_TEST_TURN");
  return turn == nullptr || static_cast<int>(core::murmur3(name) % 4) == std::atoi(turn);
}

}  // namespace hyades::test
