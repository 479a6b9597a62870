#pragma once

#include <string>
#include <vector>

#include "core/base/assets.h"

namespace hyades::core {

// UDIM: an image of several files, one per unit of uv. The tile at column u and row v (from 0) has
// the number 1001 + u + 10 v, which stands in the file's name where the pattern has <UDIM>.
inline constexpr int kFirstUdim = 1001;
inline constexpr int kUdimColumns = 10;
inline constexpr int kUdimRows = 10;

/// Whether a file's name is a pattern of such files.
bool is_udim(const std::string& file);

/// The name of one tile.
std::string udim_file(const std::string& pattern, int number);

/// The numbers of the tiles that exist, in order; an error where there is none.
Result<std::vector<int>> udim_tiles(AssetResolver& assets, const std::string& pattern);

}  // namespace hyades::core
