#pragma once

#include <string>

#include "core/base/result.h"
#include "hyades/v1/jobs.pb.h"

namespace hyades::coordinator {

/// openapi.yaml's Submission as the request that gRPC takes. The error names the field.
core::Result<v1::SubmitRequest> read_submission(const std::string& body);

}  // namespace hyades::coordinator
