#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string_view>

#include "core/base/bytes.h"

namespace hyades::test {

/// `data` in a heap block of exactly its size, so that a sanitizer sees every read past its end.
inline core::Bytes exact_bytes(std::string_view data) {
  std::shared_ptr<char[]> copy(new char[data.size()]);
  std::copy(data.begin(), data.end(), copy.get());
  const auto* first = reinterpret_cast<const std::byte*>(copy.get());
  return {copy, {first, data.size()}};
}

}  // namespace hyades::test
