#pragma once

#include <chrono>
#include <functional>
#include <mutex>
#include <type_traits>
#include <utility>

#include <grpcpp/server_context.h>
#include <grpcpp/support/server_callback.h>

#include "coordinator/services/admission.h"
#include "coordinator/services/audit_target.h"
#include "coordinator/services/executors.h"
#include "coordinator/services/part_count.h"
#include "coordinator/services/raw.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {

/// Messages in one request; a job with as many files as it may have has about half of that.
inline constexpr uint64_t kMostParts = 200'000;

/// A call on its way: who may come in, what was asked, and where the answer goes. Small; copies
/// mean the same call, which is answered once.
struct Call {
  /// `method`: as the table of rules has it.
  Call(const Admission& admission_, const char* method, grpc::CallbackServerContext* context_,
       const grpc::ByteBuffer* asked_, grpc::ByteBuffer* said_)
      : admission(admission_),
        rule(rule_of_method(method)),
        context(context_),
        asked(asked_),
        said(said_),
        reactor(context->DefaultReactor()) {}

  /// Whether the caller may do this; who he is.
  grpc::Status admit() { return admission.check(*context, rule, caller); }

  const Admission& admission;
  const Rule& rule;
  Caller caller;  ///< once admitted
  grpc::CallbackServerContext* context;
  const grpc::ByteBuffer* asked;
  grpc::ByteBuffer* said;
  grpc::ServerUnaryReactor* reactor;  ///< every DefaultReactor() makes it anew

  /// Before finish(), of what changes something.
  void note(const grpc::Status& status, const google::protobuf::Message& request,
            const google::protobuf::Message& response) const {
    if (!rule.audited) return;
    admission.note(caller, rule, audit_target(request, response), status, audit_detail(request));
  }

  template <class Response>
  void finish(const grpc::Status& status, const Response& response) const {
    reactor->Finish(status.ok() ? serialise(response, *said) : status);
  }
};

/// Answers with what `what(request, response)`, or `what(request, response, caller)`, makes of the
/// request, or its status. A request has at most `limit` bytes; of those larger than usual one at a
/// time is looked at.
template <class Request, class Response, class What>
void answer_here(const Call& call, What& what, uint64_t limit) {
  Response response;
  const auto work = [&]() -> grpc::Status {
    std::unique_lock<std::mutex> alone;
    if (call.asked->Length() > farm::kMaxRequestBytes) {
      alone = call.admission.alone();
      if (!alone) {
        return farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED,
                                 "another large request is being looked at",
                                 std::chrono::milliseconds(500));
      }
      if (!has_few_parts(*call.asked, *Request::descriptor(), kMostParts)) {
        return {grpc::StatusCode::INVALID_ARGUMENT,
                fmt::format("more than {} parts in one request, or no {}", kMostParts,
                            Request::descriptor()->name())};
      }
    }
    Request request;
    if (const grpc::Status read = parse(*call.asked, limit, request); !read.ok()) return read;
    grpc::Status done;
    if constexpr (std::is_invocable_v<What&, Request&, Response&, const Caller&>) {
      done = what(request, response, call.caller);
    } else {
      done = what(request, response);
    }
    call.note(done, request, response);
    return done;
  };
  const grpc::Status status = work();
  call.finish(status, response);
}

/// An admitted call is answered on gRPC's own thread: for what never waits.
template <class Request, class Response, class What>
grpc::ServerUnaryReactor* answer(Call call, What what) {
  if (const grpc::Status admitted = call.admit(); !admitted.ok()) {
    call.reactor->Finish(admitted);
  } else {
    answer_here<Request, Response>(call, what, farm::kMaxRequestBytes);
  }
  return call.reactor;
}

/// An admitted call is answered by a thread of `pool`: for what may wait.
template <class Request, class Response, class What>
grpc::ServerUnaryReactor* answer_by(ThreadPool& pool, Call call, What what,
                                    uint64_t limit = farm::kMaxRequestBytes) {
  if (const grpc::Status admitted = call.admit(); !admitted.ok()) {
    call.reactor->Finish(admitted);
  } else if (!pool.submit([call, what, limit]() mutable {
               answer_here<Request, Response>(call, what, limit);
             })) {
    call.reactor->Finish(crowded());
  }
  return call.reactor;
}

/// An admitted call is answered at once where `known(request, response)` says yes, and otherwise by
/// a thread of `pool`, with what `what` makes of it.
template <class Request, class Response, class Known, class What>
grpc::ServerUnaryReactor* answer_or_by(ThreadPool& pool, Call call, Known known, What what) {
  Request request;
  Response response;
  grpc::Status status = call.admit();
  if (status.ok()) status = parse(*call.asked, farm::kMaxRequestBytes, request);
  if (!status.ok()) {
    call.reactor->Finish(status);
  } else if (known(request, response)) {
    call.finish(grpc::Status::OK, response);
  } else if (!pool.submit([call, what, request = std::move(request)] {
               Response found;
               const grpc::Status done = within_memory([&] { return what(request, found); });
               call.finish(done, found);
             })) {
    call.reactor->Finish(crowded());
  }
  return call.reactor;
}

}  // namespace hyades::coordinator
