#pragma once

#include "coordinator/scheduler/actions.h"
#include "hyades/v1/work.pb.h"

namespace hyades::coordinator {

/// A lease as workers know it, and back.
v1::LeaseId to_wire(const LeaseId& lease);
inline LeaseId from_wire(const v1::LeaseId& wire) { return {wire.incarnation(), wire.number()}; }
/// A unit that a worker has under the lease.
v1::LeasedUnit to_wire(const LeaseId& lease, JobId job, const core::Unit& unit);
/// Why the scheduler does not take a result, as its worker is told.
v1::Rejected::Reason to_wire(RejectReason reason);

/// The verdict on a result that is not taken, for Meters::result().
const char* verdict_of(v1::Rejected::Reason reason);

}  // namespace hyades::coordinator
