#pragma once

#include <string>

#include "core/base/result.h"

namespace hyades::coordinator {

/// Makes sure that the folder with assets and outputs is that of the farm with this secret
/// (JobStore::secret): what no job of a farm names is removed, so another farm's would be lost.
/// FILES/farm-id says whose it is. A folder without one is taken if it holds nothing, or if it
/// `was_ours`: from before there were such files. An error that names the folder otherwise.
core::Status claim_files(const std::string& files, const std::string& secret, bool was_ours);

}  // namespace hyades::coordinator
