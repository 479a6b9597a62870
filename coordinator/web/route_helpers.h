#pragma once

#include <string>
#include <utility>

#include "coordinator/access/caller.h"
#include "coordinator/controller/within_memory.h"
#include "coordinator/operations/executors.h"
#include "coordinator/operations/operation.h"
#include "coordinator/web/exchange.h"
#include "coordinator/web/request_form.h"
#include "coordinator/web/router.h"

namespace hyades::coordinator {

/// The WebReply that `make()` gives; an error where there is no memory for it.
template <class Make>
WebReply reply_in_memory(const Make& make) {
  WebReply reply;
  const grpc::Status done = within_memory([&] {
    reply = make();
    return grpc::Status::OK;
  });
  return done.ok() ? reply : error_reply(done);
}

/// Answers with the WebReply that `what()` gives: where the route's row says, when it is the
/// caller's turn there.
template <class What>
void answer_by(Executors& executors, const std::string& route, const Caller& caller,
               const Answer& answer, const What& what) {
  farm::ThreadPool* pool = executors.of(operation_of_route(route).runs);
  if (pool == nullptr) return answer(reply_in_memory(what));
  const bool taken =
      pool->submit([answer, what] { answer(reply_in_memory(what)); }, owner_of(caller).name);
  if (!taken) answer(error_reply(crowded()));
}

/// Adds a route that is served by hand: `what(asked, request, answer)` is called by the network's
/// thread, with what the path and the query say as an Asked (a message).
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

/// Adds a route that is served by hand, and answered with the WebReply that `what(asked, request)`
/// gives, where its row says. `asked`: what the path and the query say.
template <class Asked, class What>
void add_by_hand(Router& router, Executors& executors, const std::string& method,
                 const std::string& pattern, What what) {
  add_by_hand<Asked>(router, method, pattern,
                     [&executors, route = method + " " + pattern, what](
                         const Asked& asked, const WebRequest& request, const Answer& answer) {
                       answer_by(executors, route, request.caller, answer,
                                 [what, asked, request] { return what(asked, request); });
                     });
}

}  // namespace hyades::coordinator
