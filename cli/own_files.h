#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace hyades::cli {

/// Whether the file says that it was rendered for a job of that name: pictures, films and videos
/// say so in their headers.
bool is_of_job(const std::string& path, const std::string& job);

/// An error where some of the files are there and were made by somebody else; they are named as
/// `--overwrite` would replace them.
core::Status check_own_files(const std::vector<std::string>& paths, const std::string& job);

}  // namespace hyades::cli
