#pragma once

#include <vector>

#include "core/base/result.h"
#include "core/sandbox/landlock.h"

namespace hyades::core {

/// From now on this process sees a file system of its own, in which the places of `rules` stand
/// where they stood (read-only where a rule says so) and nothing else does: what Landlock keeps
/// from being opened cannot be found by stat() either. It gets a user and a mount namespace for
/// that. For a process with one thread, before restrict_files(). Errors: why the machine does not
/// allow it, as containers and some distributions do not; it may be in the namespaces then, and
/// sees all files.
Status hide_other_files(const std::vector<FileRule>& rules);

}  // namespace hyades::core
