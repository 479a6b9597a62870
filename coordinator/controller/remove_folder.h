#pragma once

#include <cstdint>
#include <string>

namespace hyades::coordinator {

/// Removes at most `most` files of the folder and those below it, and each folder that is empty
/// then; follows no links. Whether all of it has been gone through: what is left then cannot be
/// removed.
bool remove_some(const std::string& folder, uint64_t most);

}  // namespace hyades::coordinator
