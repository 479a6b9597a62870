#include "coordinator/controller/to_wire.h"

#include <cstdint>

#include "farm/wire.h"

namespace hyades::coordinator {

v1::LeaseId to_wire(const LeaseId& lease) {
  v1::LeaseId wire;
  wire.set_incarnation(lease.incarnation);
  wire.set_number(lease.number);
  return wire;
}

v1::LeasedUnit to_wire(const LeaseId& lease, JobId job, const core::Unit& unit) {
  v1::LeasedUnit wire;
  *wire.mutable_lease() = to_wire(lease);
  wire.set_job(static_cast<uint64_t>(job));
  *wire.mutable_unit() = farm::to_wire(unit);
  return wire;
}

v1::Rejected::Reason to_wire(RejectReason reason) {
  switch (reason) {
    case RejectReason::unknown:
      return v1::Rejected::REASON_UNKNOWN;
    case RejectReason::malformed:
      return v1::Rejected::REASON_MALFORMED;
    case RejectReason::overlap:
      return v1::Rejected::REASON_OVERLAP;
    case RejectReason::conflict:
      return v1::Rejected::REASON_CONFLICT;
    case RejectReason::not_now:
      return v1::Rejected::REASON_NOT_NOW;
  }
  return v1::Rejected::REASON_UNSPECIFIED;
}

const char* verdict_of(v1::Rejected::Reason reason) {
  switch (reason) {
    case v1::Rejected::REASON_DAMAGED:
      return "damaged";
    case v1::Rejected::REASON_MALFORMED:
      return "malformed";
    case v1::Rejected::REASON_OVERLAP:
      return "overlap";
    case v1::Rejected::REASON_CONFLICT:
      return "conflict";
    case v1::Rejected::REASON_NOT_NOW:
      return "not_now";
    default:
      return "unknown";
  }
}

}  // namespace hyades::coordinator
