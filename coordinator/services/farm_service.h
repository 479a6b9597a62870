#pragma once

#include "coordinator/brain/brain.h"
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
  FarmService(Brain& brain, const Admission& admission) : brain_(brain), admission_(admission) {}

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
  Brain& brain_;
  const Admission& admission_;
};

}  // namespace hyades::coordinator
