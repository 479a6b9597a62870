#pragma once

#include <string>

#include "core/base/result.h"

namespace hyades::core {

/// The instruction set that Embree is pinned to on this machine: "avx2", or "sse4.2" where the
/// processor has no AVX2. Bits of hits differ between the two, so it is part of a worker's class.
/// Errors: Embree supports neither here.
Result<std::string> embree_isa();

/// The version of the Embree that was compiled against: "3.13.5".
std::string embree_version();

/// The version of the Embree that is loaded, which may be a newer one; empty where Embree does not
/// run here.
std::string loaded_embree_version();

}  // namespace hyades::core
