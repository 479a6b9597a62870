#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "import/gltf/json_value.h"

namespace hyades::core {

/// Which extensions a file needs and uses: an error for one that is required and not known here, a
/// note for each that is used, not required and not known.
Status check_extensions(const JsonValue& root, std::vector<std::string>& notes);

}  // namespace hyades::core
