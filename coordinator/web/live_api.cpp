#include "coordinator/web/live_api.h"

#include <chrono>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "coordinator/access/caller.h"
#include "coordinator/web/job_events.h"
#include "coordinator/web/route_helpers.h"

namespace hyades::coordinator {
namespace {

constexpr std::chrono::seconds kTick{1};

WebReply live() {
  WebReply reply;
  reply.type = "text/event-stream; charset=utf-8";
  reply.headers = {{"Cache-Control", "no-store"}, {"X-Accel-Buffering", "no"}};
  return reply;
}

}  // namespace

LiveApi::LiveApi(Controller& controller, Executors& executors, boost::asio::io_context& network,
                 std::shared_ptr<IoHandle> io)
    : controller_(controller),
      executors_(executors),
      io_(std::move(io)),
      timer_(network),
      farm_(std::make_shared<FarmFeed>(controller, executors)) {}

void LiveApi::add_routes(Router& router) {
  router.add("GET", "/api/v1/events", [this](const WebRequest&, const Answer& answer) {
    WebReply reply = live();
    reply.topic = farm_;
    answer(std::move(reply));
  });
  add_by_hand<v1::JobRequest>(
      router, executors_, "GET", "/api/v1/jobs/{job}/events",
      [this](const v1::JobRequest& asked, const WebRequest&) {
        // Whether there is such a job is known before the stream begins.
        v1::GetJobResponse got;
        const grpc::Status status = controller_.queries().get(asked.job(), INT32_MAX, got);
        if (!status.ok()) return error_reply(status);
        WebReply reply = live();
        reply.source = std::make_shared<JobEvents>(controller_, asked.job());
        return reply;
      });
}

void LiveApi::begin() { tick(); }

void LiveApi::tick() {
  farm_->tick();
  timer_.expires_after(kTick);
  timer_.async_wait([this](const boost::system::error_code& error) {
    if (!error) tick();
  });
}

}  // namespace hyades::coordinator
