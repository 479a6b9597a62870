#pragma once

#include <string>

#include "core/base/result.h"

namespace hyades::coordinator {

/// For `hyades-film finish`, before it opens what a job brings (a configuration of OpenColorIO and
/// its tables): beside it lie the coordinator's keys, tokens and job store. From now on this
/// process writes only below `scratch` and `outputs`, reads besides only programs, libraries and
/// what OpenColorIO and denoisers need of the system, may take three quarters of the memory, and is
/// the first to go where the machine runs out of it. Errors: why the machine cannot do that.
core::Status confine_finisher(const std::string& scratch, const std::string& outputs);

}  // namespace hyades::coordinator
