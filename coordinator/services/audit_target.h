#pragma once

#include <string>

#include <google/protobuf/message.h>

namespace hyades::coordinator {

/// What a request was about, for the audit log: its job, worker or token; of one that makes
/// something, what the response has.
std::string audit_target(const google::protobuf::Message& request,
                         const google::protobuf::Message& response);

/// What a request says, in one line; nothing of one that is long.
std::string audit_detail(const google::protobuf::Message& request);

}  // namespace hyades::coordinator
