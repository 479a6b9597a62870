#pragma once

#include <string>

#include "core/base/result.h"

namespace hyades::core {

/// 32 hexadecimal digits that nobody else has: 128 random bits of the system's. An error where it
/// gives none.
Result<std::string> random_id();

}  // namespace hyades::core
