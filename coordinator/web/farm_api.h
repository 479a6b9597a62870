#pragma once

#include "coordinator/controller/controller.h"
#include "coordinator/operations/executors.h"
#include "coordinator/web/router.h"

namespace hyades::coordinator {

/// Whether the coordinator is well, and numbers for Prometheus.
class FarmApi {
 public:
  FarmApi(Controller& controller, Executors& executors)
      : controller_(controller), executors_(executors) {}
  void add_routes(Router& router);

 private:
  Controller& controller_;
  Executors& executors_;
};

}  // namespace hyades::coordinator
