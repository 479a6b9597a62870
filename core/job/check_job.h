#pragma once

#include "core/base/assets.h"
#include "core/job/read_context.h"

namespace hyades::core {

/// What can only be checked once the whole job has been read: that every name exists, that nothing
/// refers to itself, that groups do not unfold to absurd numbers of objects, that every file opens,
/// and that expressions stay in range over the job's frames.
void check_job(ReadContext& context, AssetResolver& assets);

}  // namespace hyades::core
