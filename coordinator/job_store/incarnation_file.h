#pragma once

#include <cstdint>
#include <string>

#include "core/base/result.h"

namespace hyades::coordinator {

/// Counts one more start in the file at `path`: the result is above what the file says and above
/// `known`, and durable. The file has its full size from the first start on and is written in
/// place, one of two blocks in turn, so that a disk without a free byte takes it, and a crash
/// leaves the other block. An error where it cannot be made, read or written.
core::Result<uint64_t> count_start(const std::string& path, uint64_t known);

}  // namespace hyades::coordinator
