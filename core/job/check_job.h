#pragma once

#include "core/base/assets.h"
#include "core/job/read_context.h"

namespace hyades::core {

/// What can only be checked once the whole job has been read: that every name exists, that nothing
/// refers to itself, that groups do not unfold to absurd numbers of objects, that every file opens,
/// and that animated values stay in range over the job's frames (tried at up to 1,000 of them; the
/// others are checked when they are built).
void check_job(ReadContext& context, AssetResolver& assets);

}  // namespace hyades::core
