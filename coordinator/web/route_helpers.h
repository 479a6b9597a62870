#pragma once

#include <string>
#include <utility>

#include "coordinator/operations/executors.h"
#include "coordinator/web/exchange.h"
#include "coordinator/web/request_form.h"
#include "coordinator/web/router.h"

namespace hyades::coordinator {

/// Has a thread of `pool` answer with what `what` gives, a WebReply: for what may wait for the
/// disk.
template <class What>
void answer_by(ThreadPool& pool, const Answer& answer, What what) {
  const bool taken = pool.submit([answer, what = std::move(what)]() mutable {
    WebReply reply;
    const grpc::Status done = within_memory([&] {
      reply = what();
      return grpc::Status::OK;
    });
    answer(done.ok() ? std::move(reply) : error_reply(done));
  });
  if (!taken) answer(error_reply(crowded()));
}

/// Adds a route that is served by hand: `what(asked, request, answer)`, with what the path and the
/// query say as an Asked.
template <class Asked, class What>
void add_by_hand(Router& router, const std::string& method, const std::string& pattern, What what) {
  const std::string name = method + " " + pattern;
  const Route& route = find_route(operation_of_route(name), name);
  router.add(method, pattern,
             [&route, what = std::move(what)](const WebRequest& request, const Answer& answer) {
               Asked asked;
               const grpc::Status read = read_target(request, route, asked);
               if (!read.ok()) return answer(error_reply(read));
               what(asked, request, answer);
             });
}

/// Adds one where a thread of `pool` answers with what `what(asked, request)` gives.
template <class Asked, class What>
void add_by_hand(Router& router, ThreadPool& pool, const std::string& method,
                 const std::string& pattern, What what) {
  add_by_hand<Asked>(
      router, method, pattern,
      [&pool, what](const Asked& asked, const WebRequest& request, const Answer& answer) {
        answer_by(pool, answer, [what, asked, request] { return what(asked, request); });
      });
}

}  // namespace hyades::coordinator
