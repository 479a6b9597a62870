#pragma once

#include <cstdint>
#include <string>

#include <google/protobuf/message.h>

#include "coordinator/access/audit_log.h"

namespace hyades::coordinator {

/// What a request was about, for the audit log: its job, worker or token; of one that makes
/// something, what the response has.
std::string audit_target(const google::protobuf::Message& request,
                         const google::protobuf::Message& response);

/// What a request says, in one line; nothing of one that is long.
std::string audit_detail(const google::protobuf::Message& request);

/// Notes that somebody begins to upload a file of `size` bytes, of which `begun` are here already:
/// once for a file, however many pieces it comes in. `log` may be null.
void note_upload(AuditLog* log, const Caller& caller, const std::string& sha256, uint64_t size,
                 uint64_t begun);

}  // namespace hyades::coordinator
