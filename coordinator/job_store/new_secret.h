#pragma once

#include <string>

#include "core/base/result.h"

namespace hyades::coordinator {

/// What a store that is new keeps as JobStore::secret(): 256 random bits of the system's. An error
/// where it gives none.
core::Result<std::string> new_secret();

}  // namespace hyades::coordinator
