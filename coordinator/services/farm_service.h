#pragma once

#include "coordinator/controller/controller.h"
#include "coordinator/services/admission.h"
#include "hyades/v1/farm.grpc.pb.h"

namespace hyades::coordinator {

/// All methods of Farm by bytes (raw.h).
using RawFarm = v1::Farm::WithRawCallbackMethod_Info<v1::Farm::WithRawCallbackMethod_Workers<
    v1::Farm::WithRawCallbackMethod_DrainWorker<v1::Farm::WithRawCallbackMethod_QuarantineWorker<
        v1::Farm::WithRawCallbackMethod_ReleaseWorker<v1::Farm::Service>>>>>;

/// What operators ask for (farm_service.cpp).
class FarmService final : public RawFarm {
 public:
  FarmService(Controller& controller, const Admission& admission)
      : controller_(controller), admission_(admission) {}

  using Context = grpc::CallbackServerContext;
  using Bytes = grpc::ByteBuffer;
  grpc::ServerUnaryReactor* Info(Context* context, const Bytes* asked, Bytes* said) override;
  grpc::ServerUnaryReactor* Workers(Context* context, const Bytes* asked, Bytes* said) override;
  grpc::ServerUnaryReactor* DrainWorker(Context* context, const Bytes* asked, Bytes* said) override;
  grpc::ServerUnaryReactor* QuarantineWorker(Context* context, const Bytes* asked,
                                             Bytes* said) override;
  grpc::ServerUnaryReactor* ReleaseWorker(Context* context, const Bytes* asked,
                                          Bytes* said) override;

 private:
  Controller& controller_;
  const Admission& admission_;
};

}  // namespace hyades::coordinator
