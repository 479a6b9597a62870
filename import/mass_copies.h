#pragma once

#include <cstddef>

#include "core/base/vec.h"

/// Where a scene places one thing many times, its copies become one object with a file of places
/// (docs/job.md, "Instance") in place of an object each.
namespace hyades::core {

/// From so many copies of a thing on they are told by a file.
inline constexpr size_t kFewestCopies = 64;

/// Most copies of one scene in such files: some 10 GB when they are rendered.
inline constexpr size_t kMostCopies = 50'000'000;

/// Whether a copy in a file may have this matrix: what is flat or tiny (below some ten-thousandth)
/// has to be an object by itself.
bool can_be_copied(const Mat4& in_scene);

}  // namespace hyades::core
