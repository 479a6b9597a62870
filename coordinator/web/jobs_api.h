#pragma once

#include "coordinator/controller/controller.h"
#include "coordinator/operations/executors.h"
#include "coordinator/web/router.h"

namespace hyades::coordinator {

/// A job's log, page by page, and its document.
class JobsApi {
 public:
  JobsApi(Controller& controller, Executors& executors)
      : controller_(controller), executors_(executors) {}
  void add_routes(Router& router);

 private:
  WebReply logs(const v1::LogsRequest& asked);
  WebReply document(uint64_t job);

  Controller& controller_;
  Executors& executors_;
};

}  // namespace hyades::coordinator
