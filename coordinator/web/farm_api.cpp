#include "coordinator/web/farm_api.h"

#include "coordinator/controller/all_pages.h"
#include "coordinator/web/handing.h"
#include "coordinator/web/metrics.h"

namespace hyades::coordinator {
namespace {

using Steer = grpc::Status (FarmControl::*)(const v1::WorkerRequest&, v1::Worker&);

/// The reason that a body may give; nothing where it is no such body.
std::optional<std::string> reason_in(const std::string& body) {
  if (body.empty()) return std::string();
  const auto json = farm::Json::parse(body, nullptr, false);
  if (!json.is_object()) return std::nullopt;
  if (!json.contains("reason")) return std::string();
  if (!json["reason"].is_string()) return std::nullopt;
  return json["reason"].get<std::string>();
}

}  // namespace

farm::Json to_json(const v1::InfoResponse& info) {
  return {{"version", info.version()},
          {"protocol", info.protocol()},
          {"oldest_protocol", info.oldest_protocol()},
          {"incarnation", info.incarnation()},
          {"started_ms", info.started_ms()},
          {"workers", info.workers()},
          {"threads", info.threads()},
          {"jobs", info.jobs()},
          {"trouble", info.trouble()},
          {"grpc_address", info.grpc_address()},
          {"price_per_core_hour", info.price_per_core_hour()},
          {"currency", info.currency()},
          {"unguarded", info.unguarded()}};
}

void FarmApi::add_routes(Router& router) {
  router.add("GET", "/healthz", [](const WebRequest&, const Answer& answer) {
    answer(text_reply("well\n", "text/plain; charset=utf-8"));
  });
  router.add("GET", "/readyz", [this](const WebRequest&, const Answer& answer) {
    answer_by(executors_.files, answer, [this] {
      const grpc::Status room = controller_.disk().admit(0);
      WebReply reply = text_reply(room.ok() ? "ready\n" : room.error_message() + "\n",
                                  "text/plain; charset=utf-8");
      if (!room.ok()) reply.status = 503;
      return reply;
    });
  });
  router.add("GET", "/metrics", [this](const WebRequest&, const Answer& answer) {
    answer_by(executors_.rows, answer, [this] {
      return text_reply(metrics_text(controller_), "text/plain; version=0.0.4; charset=utf-8");
    });
  });
  router.add("GET", "/api/v1/info", [this](const WebRequest&, const Answer& answer) {
    v1::InfoResponse info;
    controller_.farm().info(info);
    answer(json_reply(to_json(info)));
  });
  router.add("GET", "/api/v1/workers", [this](const WebRequest&, const Answer& answer) {
    answer_by(executors_.rows, answer, [this] {
      farm::Json workers = farm::Json::array();
      for (const v1::Worker& worker : all_workers(controller_))
        workers.push_back(farm::to_json(worker));
      return json_reply({{"workers", std::move(workers)}});
    });
  });
  const std::pair<const char*, Steer> steers[] = {{"drain", &FarmControl::drain_worker},
                                                  {"quarantine", &FarmControl::quarantine_worker},
                                                  {"release", &FarmControl::release_worker}};
  for (const auto& [name, what] : steers) {
    router.add("POST", std::string("/api/v1/workers/{worker}/") + name,
               [this, steer = what](const WebRequest& request, const Answer& answer) {
                 const auto reason = reason_in(request.body);
                 if (!reason) {
                   answer(error_reply(
                       {grpc::StatusCode::INVALID_ARGUMENT, "expected {\"reason\": \"...\"}"}));
                   return;
                 }
                 v1::WorkerRequest asked;
                 asked.set_worker(request.parameters.at("worker"));
                 asked.set_reason(*reason);
                 answer_by(executors_.rows, answer, [this, steer, asked] {
                   v1::Worker now;
                   const grpc::Status done = (controller_.farm().*steer)(asked, now);
                   return done.ok() ? json_reply(farm::to_json(now)) : error_reply(done);
                 });
               });
  }
}

}  // namespace hyades::coordinator
