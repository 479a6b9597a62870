#pragma once

#include <mutex>
#include <string>

#include "coordinator/operations/operation.h"
#include "coordinator/web/router.h"

namespace hyades::coordinator {

/// HTTP of the table of operations: a request's path, query and body become the operation's
/// request, its response becomes JSON.
class OperationRoutes {
 public:
  OperationRoutes(Backend at, Executors& executors) : at_(at), executors_(executors) {}
  void add_routes(Router& router);

 private:
  void answer(const Operation& operation, const Route& route, const WebRequest& request,
              const Answer& answer);
  Respond<Message> responder(const Operation& operation, const Route& route,
                             const WebRequest& request, std::shared_ptr<Message> asked,
                             const Answer& answer);
  grpc::Status read(const std::string& body, const BodyForm& form, Message& message);

  Backend at_;
  Executors& executors_;
  std::mutex large_;  ///< held while a large body is looked at
};

}  // namespace hyades::coordinator
