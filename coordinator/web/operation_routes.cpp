#include "coordinator/web/operation_routes.h"

#include <cstddef>
#include <memory>
#include <string>
#include <utility>

#include "coordinator/access/caller.h"
#include "coordinator/controller/within_memory.h"
#include "coordinator/web/request_form.h"
#include "coordinator/web/route_helpers.h"

namespace hyades::coordinator {
namespace {

grpc::Status read_alone(const std::string& body, const BodyForm& form, Message& message) {
  LargeRequest large;
  const grpc::Status admitted = large.admit(body.size());
  if (!admitted.ok()) return admitted;
  return within_memory([&] { return read_body(body, form, message); });
}

HttpForm form_of(const Route& route, const Message& asked, const Message& response) {
  if (route.show) return route.show(asked, response);
  if (route.status == 204) return {nullptr, 204};
  if (route.only == nullptr) return {farm::to_json(response), route.status};
  const auto* field = response.GetDescriptor()->FindFieldByName(route.only);
  return {farm::to_json(response.GetReflection()->GetMessage(response, field)), route.status};
}

WebReply reply_of(const Route& route, const Message& asked, const Message& response) {
  return reply_in_memory([&] {
    const HttpForm form = form_of(route, asked, response);
    WebReply reply = form.body.is_null() ? empty_reply(form.status) : json_reply(form.body);
    reply.status = form.status;
    return reply;
  });
}

}  // namespace

void OperationRoutes::add_routes(Router& router) {
  for (const Operation& operation : all_operations()) {
    if (!operation.handle) continue;
    for (const Route& route : operation.routes) {
      const std::string path = route.path;
      const size_t space = path.find(' ');
      router.add(path.substr(0, space), path.substr(space + 1),
                 [this, &operation, &route](const WebRequest& request, const Answer& to) {
                   answer(operation, route, request, to);
                 });
    }
  }
}

void OperationRoutes::answer(const Operation& operation, const Route& route,
                             const WebRequest& request, const Answer& to) {
  const Handler& handle = route.handle ? route.handle : operation.handle;
  const std::shared_ptr<Message> asked(handle.request().New());
  const grpc::Status target = read_target(request, route, *asked);
  if (!target.ok()) return to(error_reply(target));
  const auto work = [this, &operation, &route, &handle, asked, to, body = request.body,
                     caller = request.caller] {
    if (route.body != nullptr) {
      const grpc::Status said = read_alone(body, *route.body, *asked);
      if (!said.ok()) return to(error_reply(said));
    }
    carry_out(operation, handle, at_, *asked, caller,
              [&route, asked, to](const grpc::Status& status, const Message& response) {
                to(status.ok() ? reply_of(route, *asked, response) : error_reply(status));
              });
  };
  farm::ThreadPool* executor = executors_.of(route.handle ? route.runs : operation.runs);
  if (executor == nullptr) return work();
  if (!executor->submit(work, owner_of(request.caller).name)) to(error_reply(crowded()));
}

}  // namespace hyades::coordinator
