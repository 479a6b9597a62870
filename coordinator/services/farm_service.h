#pragma once

#include "coordinator/brain/brain.h"
#include "coordinator/services/admission.h"
#include "hyades/v1/farm.grpc.pb.h"

namespace hyades::coordinator {

/// What operators ask for (farm_service.cpp).
class FarmService final : public v1::Farm::CallbackService {
 public:
  FarmService(Brain& brain, const Admission& admission) : brain_(brain), admission_(admission) {}

  using Context = grpc::CallbackServerContext;
  grpc::ServerUnaryReactor* Info(Context* context, const v1::InfoRequest* request,
                                 v1::InfoResponse* response) override;
  grpc::ServerUnaryReactor* Workers(Context* context, const v1::WorkersRequest* request,
                                    v1::WorkersResponse* response) override;
  grpc::ServerUnaryReactor* DrainWorker(Context* context, const v1::WorkerRequest* request,
                                        v1::WorkerResponse* response) override;
  grpc::ServerUnaryReactor* QuarantineWorker(Context* context, const v1::WorkerRequest* request,
                                             v1::WorkerResponse* response) override;
  grpc::ServerUnaryReactor* ReleaseWorker(Context* context, const v1::WorkerRequest* request,
                                          v1::WorkerResponse* response) override;

 private:
  Brain& brain_;
  const Admission& admission_;
};

}  // namespace hyades::coordinator
