#pragma once

#include "coordinator/controller/controller.h"
#include "coordinator/services/executors.h"
#include "coordinator/web/router.h"
#include "farm/json_form.h"

namespace hyades::coordinator {

/// The farm and its workers; whether the coordinator is well.
class FarmApi {
 public:
  FarmApi(Controller& controller, Executors& executors)
      : controller_(controller), executors_(executors) {}
  void add_routes(Router& router);

 private:
  Controller& controller_;
  Executors& executors_;
};

/// As openapi.yaml's Info.
farm::Json to_json(const v1::InfoResponse& info);

}  // namespace hyades::coordinator
