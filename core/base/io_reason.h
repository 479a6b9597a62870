#pragma once

#include <string>

namespace hyades::core {

/// What errno value `error` means for a file or folder, in words that fit behind "cannot write X:
/// ".
std::string io_reason(int error);

}  // namespace hyades::core
