#pragma once

#include "coordinator/brain/brain.h"
#include "coordinator/services/desks.h"
#include "coordinator/web/router.h"
#include "farm/json_form.h"

namespace hyades::coordinator {

/// The farm and its workers; whether the coordinator is well.
class FarmApi {
 public:
  FarmApi(Brain& brain, Desks& desks) : brain_(brain), desks_(desks) {}
  void add_routes(Router& router);

 private:
  Brain& brain_;
  Desks& desks_;
};

/// As openapi.yaml's Info.
farm::Json to_json(const v1::InfoResponse& info);

}  // namespace hyades::coordinator
