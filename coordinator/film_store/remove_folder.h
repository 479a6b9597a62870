#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hyades::coordinator {

/// Removes at most `most` files of the folder and those below it, and each folder that is empty
/// then; follows no links. Whether all of it has been gone through: what is left then cannot be
/// removed.
bool remove_some(const std::string& folder, uint64_t most);

/// The numbers that are names of what is in the folder, in any order; none where it cannot be read.
std::vector<uint64_t> numbered_folders(const std::string& folder);

}  // namespace hyades::coordinator
