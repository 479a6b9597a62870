#pragma once

#include "core/base/result.h"
#include "core/image/image.h"

namespace hyades::core {

/// Cuts `a` and `b` to the part of the frame that both show: crops compare with whole pictures and
/// with each other. A picture without a placement is a whole frame. Error: frames of different
/// sizes, or nothing in common.
Status cut_to_common_part(Image& a, Image& b);

}  // namespace hyades::core
