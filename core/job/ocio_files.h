#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hyades::core {

/// Where files may be that a configuration of OpenColorIO names (`src` of its FileTransforms): each
/// as written if it is absolute, else below each folder of its search path, or beside it where it
/// has none; at most 10,000. Relative to the configuration. Names with variables ($SHOT) are left
/// out: nobody sets them here. The text is looked through once, not understood: what a broken one
/// gives is of no harm.
std::vector<std::string> ocio_file_candidates(std::string_view config);

}  // namespace hyades::core
