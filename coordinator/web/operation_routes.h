#pragma once

#include "coordinator/operations/operation.h"
#include "coordinator/web/router.h"

namespace hyades::coordinator {

/// HTTP of the table of operations: a request's path, query and body become the operation's
/// request, its response becomes JSON.
class OperationRoutes {
 public:
  /// What the arguments refer to outlives it.
  OperationRoutes(Backend at, Executors& executors) : at_(at), executors_(executors) {}
  /// Adds the routes of all operations that have a handler; they refer to this object.
  void add_routes(Router& router);

 private:
  void answer(const Operation& operation, const Route& route, const WebRequest& request,
              const Answer& answer);

  Backend at_;
  Executors& executors_;
};

}  // namespace hyades::coordinator
