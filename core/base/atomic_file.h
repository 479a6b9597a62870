#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>

#include "core/base/result.h"

namespace hyades::core {

/// Makes `path` hold exactly what `write` produces, or leaves it untouched: `write` gets a
/// temporary path in the same folder, which is then synced and renamed onto `path` (and the folder
/// synced). The temporary is removed on failure.
Status replace_file(const std::string& path,
                    const std::function<Status(const std::string&)>& write);

/// replace_file with ready bytes.
Status write_file(const std::string& path, std::span<const std::byte> bytes);

}  // namespace hyades::core
