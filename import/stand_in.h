#pragma once

#include <string>

#include "core/base/bytes.h"

namespace hyades::core {

/// Whether a file is a picture by its name: .png, .jpg, .exr, ...
bool names_picture(const std::string& reference);

/// A PNG of one magenta pixel, for a picture that is not there. Images are told apart by what they
/// hold, so that it may have any name.
Bytes magenta_picture();

}  // namespace hyades::core
