#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "core/base/assets.h"
#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/geometry/curve_set.h"

namespace hyades::core {

/// Reads strands from a file of Cem Yuksel's HAIR format (cemyuksel.com, "HAIR Model Files"),
/// perhaps packed by gzip: thickness (the diameter) and colour (taken as linear Rec.709) of each
/// point, or of the whole file; transparency is not looked at. `basis` says what the points mean.
/// Errors name the file: another format, a file that is cut short, colours
/// beyond 0 to 1, what make_curve_set() refuses;
/// more than there is memory for (`room` bytes; 0: not known), told before any is taken.
Result<std::shared_ptr<const CurveSet>> read_hair(AssetResolver& assets,
                                                  const std::string& reference, CurveBasis basis,
                                                  size_t room);

/// A file of these strands that read_hair() reads back to the last bit, where radii are halves of
/// floats. Of `sizes`, each must be below 65,537.
Bytes hair_bytes(const StrandList& strands);

}  // namespace hyades::core
