#pragma once

#include "coordinator/scheduler/actions.h"
#include "hyades/v1/work.pb.h"

namespace hyades::coordinator {

v1::LeaseId to_wire(const LeaseId& lease);
inline LeaseId from_wire(const v1::LeaseId& wire) { return {wire.incarnation(), wire.number()}; }
/// A unit that a worker has under the lease.
v1::LeasedUnit to_wire(const LeaseId& lease, JobId job, const core::Unit& unit);
v1::Rejected::Reason to_wire(RejectReason reason);

}  // namespace hyades::coordinator
