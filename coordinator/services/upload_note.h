#pragma once

#include <string>

#include "coordinator/access/audit_log.h"

namespace hyades::coordinator {

/// Notes that somebody begins to upload a file of `size` bytes, of which `begun` are here already:
/// once for a file, however many pieces it comes in. `log` may be null.
void note_upload(AuditLog* log, const Caller& caller, const std::string& sha256, uint64_t size,
                 uint64_t begun);

}  // namespace hyades::coordinator
