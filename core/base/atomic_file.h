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

/// Writes `bytes` to `path` in place: for the `write` of replace_file. A full disk, a missing
/// folder and the like are named.
Status write_in_place(const std::string& path, std::span<const std::byte> bytes);

/// replace_file with ready bytes.
Status write_file(const std::string& path, std::span<const std::byte> bytes);

}  // namespace hyades::core
