#pragma once

#include "coordinator/scheduler/ids.h"
#include "hyades/v1/work.pb.h"

namespace hyades::coordinator {

inline LeaseId lease_from_wire(const v1::LeaseId& wire) {
  return {wire.incarnation(), wire.number()};
}

/// The most that a worker may have.
inline constexpr uint32_t kMostThreads = 4096;

}  // namespace hyades::coordinator
