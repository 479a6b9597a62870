#pragma once

#include <vector>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "import/gltf/json_value.h"

namespace hyades::core {

/// The bytes of a view that EXT_meshopt_compression holds, decoded and unfiltered. `extension` is
/// the extension's object. Errors name its place.
Result<Bytes> decode_meshopt(const JsonValue& extension, const std::vector<Bytes>& buffers);

}  // namespace hyades::core
