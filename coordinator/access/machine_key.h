#pragma once

#include <string>

#include "core/base/result.h"

namespace hyades::coordinator {

/// The key of machines' tokens (Authority::Options::machine_key), from FOLDER/machine-key, which is
/// made where it is not there. No back-up has it: who reads one can make no tokens, and on a farm
/// that comes from one machines join anew. An error that names the file.
core::Result<std::string> machine_key(const std::string& folder);

}  // namespace hyades::coordinator
