// What people's programs send over gRPC: submissions, questions and orders about jobs and workers,
// tokens. The first byte chooses the message; the rest is parsed and goes to a coordinator without
// network. A worker's Hello, and what it says then, goes there too.

#include <cstdlib>
#include <future>
#include <memory>

#include "farm/json_form.h"
#include "hyades/v1/admin.pb.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_farm.h"

namespace hyades::fuzz {
namespace {

using coordinator::Controller;
using coordinator::JobReply;

Farm& farm() {
  static Farm one;
  return one;
}

/// What an order about a job came to.
template <class Order>
grpc::Status told(Order order) {
  auto said = std::make_shared<std::promise<grpc::Status>>();
  auto answer = said->get_future();
  order([said](const grpc::Status& status, const v1::Job& job) {
    (void)farm::to_json(job);
    said->set_value(status);
  });
  return answer.get();
}

/// A submission that is taken is a job, and can be shown, ended and forgotten.
bool try_submission(const v1::SubmitRequest& request) {
  Controller& controller = *farm().controller;
  v1::SubmitResponse response;
  if (!controller.jobs().submit(request, false, response).ok()) return false;
  const uint64_t job = response.job().id();
  v1::GetJobResponse got;
  if (!controller.queries().get(job, std::nullopt, got).ok()) std::abort();
  (void)farm::to_json(got.job());
  if (response.existed() || job == farm().job) return true;
  if (!told([&](JobReply then) { controller.steering().cancel(job, {}, std::move(then)); }).ok())
    return true;
  (void)controller.jobs().remove(job);
  return true;
}

bool try_orders(const v1::JobRequest& request) {
  Controller& controller = *farm().controller;
  const uint64_t job = request.job();
  const bool paused =
      told([&](JobReply then) { controller.steering().pause(job, {}, std::move(then)); }).ok();
  if (paused &&
      !told([&](JobReply then) { controller.steering().resume(job, {}, std::move(then)); }).ok()) {
    std::abort();
  }
  v1::ExplainResponse why;
  return controller.diagnosis().explain(job, why).ok() && paused;
}

bool try_worker_orders(const v1::WorkerRequest& request) {
  coordinator::FarmControl& farm_control = farm().controller->farm();
  const auto known = [&](auto order) {
    auto said = std::make_shared<std::promise<bool>>();
    auto answer = said->get_future();
    (farm_control.*order)(request, [said](const grpc::Status& status, const v1::Worker&) {
      said->set_value(status.ok());
    });
    return answer.get();
  };
  const bool drained = known(&coordinator::FarmControl::drain_worker);
  const bool barred = known(&coordinator::FarmControl::quarantine_worker);
  const bool freed = known(&coordinator::FarmControl::release_worker);
  return drained || barred || freed;
}

bool try_token(const v1::CreateTokenRequest& request) {
  std::string secret;
  coordinator::StoredToken row;
  // Never made for good: a farm with tokens asks for them.
  if (request.role() == v1::ROLE_ADMIN) return true;
  return farm()
             .authority->create(request.name(), request.role(), request.lifetime_ms(), secret, row)
             .error_code() != grpc::StatusCode::INTERNAL;
}

class Deaf : public coordinator::WorkerLink {
 public:
  void send(grpc::ByteBuffer /*message*/) override {}
  void close(const grpc::Status& /*status*/) override {}
};

/// The message is a worker's first, or what a proper worker says second.
bool try_worker(const v1::WorkerMessage& message) {
  Controller& controller = *farm().controller;
  const auto link = std::make_shared<Deaf>();
  v1::Hello hello;
  hello.set_protocol(farm::kProtocol);
  hello.set_worker_id("fuzzing-worker-1");
  hello.set_instance("fuzzing-instance-1");
  hello.set_name("fuzzing/1");
  hello.set_worker_class("class");
  hello.set_threads(1);
  hello.set_want(2);
  coordinator::WorkerId worker{};
  if (!controller.workers()
           .attach(message.has_hello() ? message.hello() : hello, link, worker)
           .ok())
    return false;
  if (!message.has_hello()) controller.workers().receive(worker, link.get(), message);
  v1::WorkersResponse all;
  controller.farm().workers({}, all);
  for (const v1::Worker& one : all.workers()) (void)farm::to_json(one);
  controller.workers().detach(worker, link.get());
  return true;
}

template <class Request, class Try>
bool parsed(const std::string& bytes, Try attempt) {
  Request request;
  return request.ParseFromString(bytes) && attempt(request);
}

}  // namespace

std::vector<std::string> seeds() {
  const uint64_t job = farm().job;
  v1::SubmitRequest whole = Farm::submission();
  v1::FrameRange& range = *whole.mutable_spec()->add_frames();
  range.set_first(1);
  range.set_last(3);
  range.set_step(2);
  whole.mutable_spec()->set_samples(16);
  whole.set_idempotency_key("0123456789abcdef");
  whole.set_priority(5);
  whole.add_tags("gpu");
  whole.set_memory_bytes(1U << 30U);
  whole.set_frame_order(v1::FRAME_ORDER_PROGRESSIVE);
  v1::JobRequest one;
  one.set_job(job);
  v1::GetJobRequest get;
  get.set_job(job);
  get.set_after(1);
  v1::ListJobsRequest list;
  list.set_ended(true);
  list.set_owner("ada");
  list.set_limit(2);
  v1::ListTimelineRequest timeline;
  timeline.set_job(job);
  v1::SetPriorityRequest priority;
  priority.set_job(job);
  priority.set_priority(3);
  v1::WorkersRequest workers;
  workers.set_after(0);
  v1::CreateTokenRequest token;
  token.set_name("ada");
  token.set_role(v1::ROLE_SUBMITTER);
  token.set_lifetime_ms(1000);
  v1::WorkerMessage hello;
  hello.mutable_hello()->set_protocol(farm::kProtocol);
  hello.mutable_hello()->set_worker_id("another-worker-22");
  hello.mutable_hello()->set_instance("another-instance-22");
  hello.mutable_hello()->set_name("another/22");
  hello.mutable_hello()->set_worker_class("class");
  hello.mutable_hello()->set_threads(4);
  hello.mutable_hello()->set_memory_bytes(1U << 30U);
  hello.mutable_hello()->add_tags("gpu");
  v1::WorkerMessage beat;
  beat.mutable_heartbeat()->set_number(1);
  beat.mutable_heartbeat()->add_leases()->mutable_lease()->set_number(1);
  return {"s" + Farm::submission().SerializeAsString(),
          "s" + whole.SerializeAsString(),
          "j" + one.SerializeAsString(),
          "g" + get.SerializeAsString(),
          "l" + list.SerializeAsString(),
          "t" + timeline.SerializeAsString(),
          "p" + priority.SerializeAsString(),
          "w" + workers.SerializeAsString(),
          "k" + token.SerializeAsString(),
          "a" + hello.SerializeAsString(),
          "a" + beat.SerializeAsString()};
}

bool try_input(std::string_view input) {
  if (input.empty()) return false;
  Controller& controller = *farm().controller;
  const std::string bytes(input.substr(1));
  switch (input.front()) {
    case 's':
      return parsed<v1::SubmitRequest>(bytes, try_submission);
    case 'j':
      return parsed<v1::JobRequest>(bytes, try_orders);
    case 'g':
      return parsed<v1::GetJobRequest>(bytes, [&](const v1::GetJobRequest& request) {
        v1::GetJobResponse got;
        const auto after = request.has_after() ? std::optional(request.after()) : std::nullopt;
        return controller.queries().get(request.job(), after, got, request.state()).ok();
      });
    case 'l':
      return parsed<v1::ListJobsRequest>(bytes, [&](const v1::ListJobsRequest& request) {
        v1::ListJobsResponse open;
        v1::ListJobsResponse all;
        (void)controller.queries().list_open(request, open);
        return controller.queries().list(request, all).ok();
      });
    case 't':
      return parsed<v1::ListTimelineRequest>(bytes, [&](const v1::ListTimelineRequest& request) {
        v1::ListTimelineResponse steps;
        return controller.queries().timeline(request, steps).ok();
      });
    case 'p':
      return parsed<v1::SetPriorityRequest>(bytes, [&](const v1::SetPriorityRequest& request) {
        return told([&](JobReply then) {
                 controller.steering().set_priority(request.job(), request.priority(), {},
                                                    std::move(then));
               })
            .ok();
      });
    case 'w':
      return parsed<v1::WorkersRequest>(bytes, [&](const v1::WorkersRequest& request) {
        v1::WorkersResponse all;
        controller.farm().workers(request, all);
        return true;
      });
    case 'd':
      return parsed<v1::WorkerRequest>(bytes, try_worker_orders);
    case 'k':
      return parsed<v1::CreateTokenRequest>(bytes, try_token);
    default:
      return parsed<v1::WorkerMessage>(bytes, try_worker);
  }
}

}  // namespace hyades::fuzz
