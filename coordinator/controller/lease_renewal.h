#pragma once

#include <optional>

#include "coordinator/scheduler/ids.h"
#include "hyades/v1/work.pb.h"

namespace hyades::coordinator {

/// How long a lease in this stage is renewed that makes no progress; nothing: for ever. Workers
/// watch their renderers themselves and are quicker: this is for those that cannot end a renderer,
/// or are broken themselves.
std::optional<Duration> lease_patience(v1::LeaseProgress::Stage stage, Duration stall_time);

}  // namespace hyades::coordinator
