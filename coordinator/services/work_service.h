#pragma once

#include "coordinator/controller/controller.h"
#include "coordinator/services/admission.h"
#include "hyades/v1/work.grpc.pb.h"

namespace hyades::coordinator {

/// One stream per worker (work_service.cpp).
class WorkService final : public v1::Work::WithRawCallbackMethod_Attend<v1::Work::Service> {
 public:
  WorkService(Controller& controller, const Admission& admission)
      : controller_(controller), admission_(admission) {}
  grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>* Attend(
      grpc::CallbackServerContext* context) override;

 private:
  Controller& controller_;
  const Admission& admission_;
};

}  // namespace hyades::coordinator
