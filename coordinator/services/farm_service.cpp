#include "coordinator/services/farm_service.h"

#include "coordinator/services/answer.h"

namespace hyades::coordinator {

grpc::ServerUnaryReactor* FarmService::Info(Context* context, const v1::InfoRequest*,
                                            v1::InfoResponse* response) {
  return answer(admission_, context, [&] {
    brain_.info(*response);
    return grpc::Status::OK;
  });
}

grpc::ServerUnaryReactor* FarmService::Workers(Context* context, const v1::WorkersRequest*,
                                               v1::WorkersResponse* response) {
  return answer(admission_, context, [&] {
    brain_.workers(*response);
    return grpc::Status::OK;
  });
}

grpc::ServerUnaryReactor* FarmService::DrainWorker(Context* context,
                                                   const v1::WorkerRequest* request,
                                                   v1::WorkerResponse* response) {
  return answer(admission_, context,
                [&] { return brain_.drain_worker(*request, *response->mutable_worker()); });
}

grpc::ServerUnaryReactor* FarmService::QuarantineWorker(Context* context,
                                                        const v1::WorkerRequest* request,
                                                        v1::WorkerResponse* response) {
  return answer(admission_, context,
                [&] { return brain_.quarantine_worker(*request, *response->mutable_worker()); });
}

grpc::ServerUnaryReactor* FarmService::ReleaseWorker(Context* context,
                                                     const v1::WorkerRequest* request,
                                                     v1::WorkerResponse* response) {
  return answer(admission_, context,
                [&] { return brain_.release_worker(*request, *response->mutable_worker()); });
}

}  // namespace hyades::coordinator
