#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"

namespace hyades::farm {

/// Tags as workers carry and jobs ask for them, sorted and without repetitions. An error where one
/// is not 1 to 40 letters, digits, '-', '_' or '.', or they are more than 32.
core::Result<std::vector<std::string>> check_tags(std::vector<std::string> tags);

}  // namespace hyades::farm
