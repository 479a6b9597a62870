#include "coordinator/web/operation_routes.h"

#include <memory>
#include <utility>

#include "coordinator/access/authority.h"
#include "coordinator/operations/audit.h"
#include "coordinator/web/request_form.h"

namespace hyades::coordinator {
namespace {

HttpForm form_of(const Route& route, const Message& asked, const Message& response) {
  if (route.show) return route.show(asked, response);
  if (route.status == 204) return {nullptr, 204};
  if (route.only == nullptr) return {farm::to_json(response), route.status};
  const auto* field = response.GetDescriptor()->FindFieldByName(route.only);
  return {farm::to_json(response.GetReflection()->GetMessage(response, field)), route.status};
}

WebReply reply_of(const Route& route, const Message& asked, const Message& response) {
  WebReply reply;
  const grpc::Status made = within_memory([&] {
    const HttpForm form = form_of(route, asked, response);
    reply = form.body.is_null() ? empty_reply(form.status) : json_reply(form.body);
    reply.status = form.status;
    return grpc::Status::OK;
  });
  return made.ok() ? reply : error_reply(made);
}

/// The job or worker that a path names.
std::string target_of(const WebRequest& request) {
  for (const char* name : {"job", "worker"}) {
    const auto named = request.parameters.find(name);
    if (named != request.parameters.end()) return named->second;
  }
  return {};
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

Respond<Message> OperationRoutes::responder(const Operation& operation, const Route& route,
                                            const WebRequest& request,
                                            std::shared_ptr<Message> asked, const Answer& answer) {
  const auto reply = [&route, asked, answer](const grpc::Status& status, const Message& response) {
    answer(status.ok() ? reply_of(route, *asked, response) : error_reply(status));
  };
  AuditLog* log = at_.authority.audit();
  if (log == nullptr || !operation.rule.audited) return reply;
  return [log, &operation, caller = request.caller, target = target_of(request), asked, reply](
             const grpc::Status& status, const Message& response) {
    log->note(caller, operation.rule.action,
              target.empty() ? audit_target(*asked, response) : target, status, "over HTTP");
    reply(status, response);
  };
}

void OperationRoutes::answer(const Operation& operation, const Route& route,
                             const WebRequest& request, const Answer& to) {
  const Handler& handle = route.handle ? route.handle : operation.handle;
  const std::shared_ptr<Message> asked(handle.request().New());
  const Respond<Message> respond = responder(operation, route, request, asked, to);
  const grpc::Status target = read_target(request, route, *asked);
  if (!target.ok()) return respond(target, handle.response());
  const auto work = [this, &operation, &route, &handle, asked, respond, body = request.body,
                     caller = request.caller] {
    if (route.body != nullptr) {
      const grpc::Status said = read(body, *route.body, *asked);
      if (!said.ok()) return respond(said, handle.response());
    }
    carry_out(operation, handle, at_, *asked, caller, respond);
  };
  ThreadPool* executor = executors_.of(route.handle ? route.runs : operation.runs);
  if (executor == nullptr) return work();
  if (!executor->submit(work)) respond(crowded(), handle.response());
}

grpc::Status OperationRoutes::read(const std::string& body, const BodyForm& form,
                                   Message& message) {
  std::unique_lock<std::mutex> alone;
  if (body.size() > farm::kMaxRequestBytes) {
    alone = std::unique_lock(large_, std::try_to_lock);
    if (!alone) return crowded();
  }
  return within_memory([&] { return read_body(body, form, message); });
}

}  // namespace hyades::coordinator
