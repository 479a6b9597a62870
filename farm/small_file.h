#pragma once

#include <string>

#include "core/base/result.h"

namespace hyades::farm {

/// The bytes of a file that a person has named: a token, a certificate. An error that names it
/// where it cannot be read or has more than 4 MiB.
core::Result<std::string> read_small_file(const std::string& path);

}  // namespace hyades::farm
