#pragma once

#include <string>

#include "core/base/result.h"

namespace hyades::core {

/// Whether `reference`, as a scene file names another file, stays within the scene's folder: not
/// absolute, and not out of it by "..". A scene comes from somewhere else, and what it names is
/// read and sent to a farm; an error that says so.
Status within_folder(const std::string& reference);

}  // namespace hyades::core
