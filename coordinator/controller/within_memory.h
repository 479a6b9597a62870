#pragma once

#include <chrono>
#include <new>

#include <grpcpp/support/status.h>

#include "farm/wire_status.h"

namespace hyades::coordinator {

/// What `question` answers, or RESOURCE_EXHAUSTED where there is no memory for the answer now. For
/// questions that change nothing: a change that breaks off in its middle ends the process
/// (farm/last_words.h).
template <class Question>
grpc::Status within_memory(const Question& question) {
  try {
    return question();
  } catch (const std::bad_alloc&) {
    return farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED,
                             "the coordinator has no memory for this now", std::chrono::seconds(2));
  }
}

}  // namespace hyades::coordinator
