#pragma once

#include <string>

#include "core/base/result.h"

namespace hyades::core {

/// The one rule for what a scene may name: `reference`, which is relative to the scene's folder,
/// with "." and ".." folded away; it stays in the folder or below it. A scene comes from somewhere
/// else, and what it names is read and sent to a farm. Errors say so: an absolute path, one that
/// leads out by "..", another scheme ("http:"), what is not is_printable(), nothing at all.
Result<std::string> within_folder(const std::string& reference);

}  // namespace hyades::core
