#include "coordinator/services/farm_service.h"

#include "coordinator/services/answer.h"

namespace hyades::coordinator {

grpc::ServerUnaryReactor* FarmService::Info(Context* context, const Bytes* asked, Bytes* said) {
  return answer<v1::InfoRequest, v1::InfoResponse>(
      {admission_, "Farm/Info", context, asked, said},
      [this](const v1::InfoRequest&, v1::InfoResponse& response) {
        controller_.farm().info(response);
        return grpc::Status::OK;
      });
}

grpc::ServerUnaryReactor* FarmService::Workers(Context* context, const Bytes* asked, Bytes* said) {
  return answer<v1::WorkersRequest, v1::WorkersResponse>(
      {admission_, "Farm/Workers", context, asked, said},
      [this](const v1::WorkersRequest& request, v1::WorkersResponse& response) {
        controller_.farm().workers(request, response);
        return grpc::Status::OK;
      });
}

grpc::ServerUnaryReactor* FarmService::DrainWorker(Context* context, const Bytes* asked,
                                                   Bytes* said) {
  return answer<v1::WorkerRequest, v1::WorkerResponse>(
      {admission_, "Farm/DrainWorker", context, asked, said},
      [this](const v1::WorkerRequest& request, v1::WorkerResponse& response) {
        return controller_.farm().drain_worker(request, *response.mutable_worker());
      });
}

grpc::ServerUnaryReactor* FarmService::QuarantineWorker(Context* context, const Bytes* asked,
                                                        Bytes* said) {
  return answer<v1::WorkerRequest, v1::WorkerResponse>(
      {admission_, "Farm/QuarantineWorker", context, asked, said},
      [this](const v1::WorkerRequest& request, v1::WorkerResponse& response) {
        return controller_.farm().quarantine_worker(request, *response.mutable_worker());
      });
}

grpc::ServerUnaryReactor* FarmService::ReleaseWorker(Context* context, const Bytes* asked,
                                                     Bytes* said) {
  return answer<v1::WorkerRequest, v1::WorkerResponse>(
      {admission_, "Farm/ReleaseWorker", context, asked, said},
      [this](const v1::WorkerRequest& request, v1::WorkerResponse& response) {
        return controller_.farm().release_worker(request, *response.mutable_worker());
      });
}

}  // namespace hyades::coordinator
