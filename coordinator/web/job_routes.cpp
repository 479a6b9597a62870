#include <cstdint>
#include <string>
#include <utility>

#include "coordinator/controller/not_found.h"
#include "coordinator/web/route_helpers.h"
#include "coordinator/web/routes.h"
#include "farm/wire.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

constexpr uint32_t kLinesAtOnce = 1000;

WebReply logs(Controller& controller, const v1::LogsRequest& asked) {
  const uint64_t job = asked.job();
  const auto stored = controller.store().state(job);
  if (const grpc::Status there = job_is_there(job, stored); !there.ok()) {
    return error_reply(there);
  }
  const auto lines = controller.store().lines(job, asked.after(), kLinesAtOnce);
  if (!lines) return error_reply(farm::unavailable(lines.error()));
  farm::Json all = farm::Json::array();
  for (const StoredLine& line : *lines) {
    farm::Json one = {{"id", line.number},
                      {"time_ms", line.time_ms},
                      {"level", farm::level_name(static_cast<v1::LogLevel>(line.level))}};
    if (line.frame) one["frame"] = *line.frame;
    one["worker"] = line.worker;
    one["text"] = line.text;
    all.push_back(std::move(one));
  }
  return json_reply({{"lines", std::move(all)}, {"more", lines->size() == kLinesAtOnce}});
}

WebReply document(Controller& controller, uint64_t job) {
  const auto stored = controller.store().job(job);
  if (const grpc::Status there = job_is_there(job, stored); !there.ok()) {
    return error_reply(there);
  }
  v1::JobSpec spec;
  if (!spec.ParseFromString((*stored)->spec)) {
    return error_reply({grpc::StatusCode::DATA_LOSS, "the job's record is damaged"});
  }
  for (const v1::JobFile& file : spec.files()) {
    if (file.path() != spec.document()) continue;
    const auto bytes = controller.assets().read(farm::hex_from_wire(file.sha256()));
    if (!bytes) return error_reply({grpc::StatusCode::DATA_LOSS, bytes.error().message});
    return text_reply(std::string(bytes->chars(), bytes->size()), "text/plain; charset=utf-8");
  }
  return error_reply({grpc::StatusCode::NOT_FOUND, "the job's document is not here"});
}

}  // namespace

void add_job_routes(Router& router, Controller& controller, Executors& executors) {
  add_by_hand<v1::LogsRequest>(
      router, executors, "GET", "/api/v1/jobs/{job}/logs",
      [&](const v1::LogsRequest& asked, const WebRequest&) { return logs(controller, asked); });
  add_by_hand<v1::JobRequest>(router, executors, "GET", "/api/v1/jobs/{job}/document",
                              [&](const v1::JobRequest& asked, const WebRequest&) {
                                return document(controller, asked.job());
                              });
}

}  // namespace hyades::coordinator
