#include "core/base/random_id.h"

#include <sys/random.h>

#include <array>
#include <cstdint>

#include "core/base/hash.h"

namespace hyades::core {

Result<std::string> random_id() {
  std::array<uint8_t, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    return Error{"the system gives no random numbers"};
  }
  return to_hex(bytes);
}

}  // namespace hyades::core
