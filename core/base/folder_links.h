#pragma once

#include <filesystem>
#include <string>

#include "core/base/result.h"

namespace hyades::core {

/// Whether `path` is `folder` or lies below it; both canonical.
bool is_inside(const std::filesystem::path& path, const std::filesystem::path& folder);

/// An error where `path`, below `folder`, is to be written and a link of the disk would lead it out
/// of the folder, or to nobody knows where. Folders come from others, as scenes do; the folder
/// itself may be a link, for who names it means it. Paths that do not begin with `folder` are none
/// of its business.
Status stays_in_folder(const std::string& folder, const std::string& path);

}  // namespace hyades::core
