// The farm and its workers.
#include <utility>
#include <vector>

#include "coordinator/controller/all_pages.h"
#include "coordinator/controller/controller.h"
#include "coordinator/operations/operation.h"

namespace hyades::coordinator {
namespace {

grpc::Status info(Backend& at, const v1::InfoRequest&, v1::InfoResponse& response) {
  at.controller.farm().info(response);
  return grpc::Status::OK;
}

grpc::Status workers(Backend& at, const v1::WorkersRequest& request,
                     v1::WorkersResponse& response) {
  at.controller.farm().workers(request, response);
  return grpc::Status::OK;
}

grpc::Status workers_of_all_pages(Backend& at, const v1::WorkersRequest&,
                                  v1::WorkersResponse& response) {
  for (v1::Worker& worker : all_workers(at.controller)) *response.add_workers() = std::move(worker);
  return grpc::Status::OK;
}

HttpForm workers_form(const v1::WorkersRequest&, const v1::WorkersResponse& response) {
  farm::Json json = farm::to_json(response);
  json.erase("next_after");
  return {std::move(json)};
}

const BodyForm kReason = {
    .fields = {{"reason"}}, .expected = "expected {\"reason\": \"...\"}", .may_be_empty = true};

template <auto what>
void steer_worker(Backend& at, const v1::WorkerRequest& request,
                  const Respond<v1::WorkerResponse>& respond) {
  (at.controller.farm().*what)(request, [respond](const grpc::Status& done, const v1::Worker& now) {
    v1::WorkerResponse response;
    *response.mutable_worker() = now;
    respond(done, response);
  });
}

constexpr v1::Role kForAll = v1::ROLE_UNSPECIFIED;
Rule may_steer_worker(const char* action) { return {action, v1::ROLE_OPERATOR, false, true}; }

}  // namespace

// clang-format off
std::vector<Operation> farm_operations() {
  return {
      // What tells nothing about the farm's work.
      {{"page", kForAll, true}, "", Runs::at_once, {}, {{"GET /"}, {"GET /openapi.yaml"}, {kDashboardFiles}}},
      {{"health", kForAll, true}, "", Runs::at_once, {}, {{"GET /healthz"}}},
      {{"health", kForAll, true}, "", Runs::in_files, {}, {{"GET /readyz"}}},
      {{"farm.info", v1::ROLE_VIEWER, true}, "Farm/Info", Runs::at_once, info, {{"GET /api/v1/info"}}},
      {{"farm.workers", v1::ROLE_VIEWER}, "Farm/Workers", Runs::at_once, workers,
       {{.path = "GET /api/v1/workers", .show = workers_form, .handle = workers_of_all_pages,
         .runs = Runs::in_store}}},
      {{"farm.events", v1::ROLE_VIEWER}, "", Runs::at_once, {}, {{"GET /api/v1/events"}}},
      {{"farm.metrics", v1::ROLE_VIEWER}, "", Runs::in_store, {}, {{"GET /metrics"}}},
      {{"worker.attend", v1::ROLE_ADMIN, true}, "Work/Attend"},
      {may_steer_worker("worker.drain"), "Farm/DrainWorker", Runs::at_once, steer_worker<&FarmControl::drain_worker>,
       {{.path = "POST /api/v1/workers/{worker}/drain", .body = &kReason, .only = "worker"}}},
      {may_steer_worker("worker.quarantine"), "Farm/QuarantineWorker", Runs::at_once,
       steer_worker<&FarmControl::quarantine_worker>,
       {{.path = "POST /api/v1/workers/{worker}/quarantine", .body = &kReason, .only = "worker"}}},
      {may_steer_worker("worker.release"), "Farm/ReleaseWorker", Runs::at_once, steer_worker<&FarmControl::release_worker>,
       {{.path = "POST /api/v1/workers/{worker}/release", .body = &kReason, .only = "worker"}}},
  };
}
// clang-format on

}  // namespace hyades::coordinator
