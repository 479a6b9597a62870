#pragma once

#include <chrono>
#include <mutex>

#include <grpcpp/server_context.h>
#include <grpcpp/support/server_callback.h>

#include "coordinator/services/admission.h"
#include "coordinator/services/part_count.h"
#include "coordinator/services/raw.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {

/// Messages in one request; a job with as many files as it may have has about half of that.
inline constexpr uint64_t kMostParts = 200'000;

/// Answers an admitted call with what `what` makes of the request, or its status. A request has at
/// most `limit` bytes; of those larger than usual one at a time is looked at.
template <class Request, class Response, class What>
grpc::ServerUnaryReactor* answer(const Admission& admission, grpc::CallbackServerContext* context,
                                 const grpc::ByteBuffer* bytes, grpc::ByteBuffer* answer, What what,
                                 uint64_t limit = farm::kMaxRequestBytes) {
  const auto work = [&]() -> grpc::Status {
    if (const grpc::Status admitted = admission.check(*context); !admitted.ok()) return admitted;
    std::unique_lock<std::mutex> alone;
    if (bytes->Length() > farm::kMaxRequestBytes) {
      alone = admission.alone();
      if (!alone) {
        return farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED,
                                 "another large request is being looked at",
                                 std::chrono::milliseconds(500));
      }
      if (!has_few_parts(*bytes, *Request::descriptor(), kMostParts)) {
        return {grpc::StatusCode::INVALID_ARGUMENT,
                fmt::format("more than {} parts in one request, or no {}", kMostParts,
                            Request::descriptor()->name())};
      }
    }
    Request request;
    if (const grpc::Status read = parse(*bytes, limit, request); !read.ok()) return read;
    Response response;
    if (const grpc::Status done = what(request, response); !done.ok()) return done;
    return serialise(response, *answer);
  };
  grpc::ServerUnaryReactor* reactor = context->DefaultReactor();
  reactor->Finish(work());
  return reactor;
}

}  // namespace hyades::coordinator
