#include "coordinator/web/jobs_api.h"

#include <utility>

#include "coordinator/controller/not_there.h"
#include "coordinator/web/route_helpers.h"
#include "farm/wire.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

constexpr uint32_t kLinesAtOnce = 1000;

}  // namespace

void JobsApi::add_routes(Router& router) {
  add_by_hand<v1::LogsRequest>(
      router, executors_.store, "GET", "/api/v1/jobs/{job}/logs",
      [this](const v1::LogsRequest& asked, const WebRequest&) { return logs(asked); });
  add_by_hand<v1::JobRequest>(
      router, executors_.files, "GET", "/api/v1/jobs/{job}/document",
      [this](const v1::JobRequest& asked, const WebRequest&) { return document(asked.job()); });
}

WebReply JobsApi::logs(const v1::LogsRequest& asked) {
  const uint64_t job = asked.job();
  const auto stored = controller_.store().state(job);
  if (!stored) return error_reply(farm::unavailable(stored.error()));
  if (!*stored) {
    return error_reply(no_job(job));
  }
  const auto lines = controller_.store().lines(job, asked.after(), kLinesAtOnce);
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

WebReply JobsApi::document(uint64_t job) {
  const auto stored = controller_.store().job(job);
  if (!stored) return error_reply(farm::unavailable(stored.error()));
  if (!*stored) {
    return error_reply(no_job(job));
  }
  v1::JobSpec spec;
  spec.ParseFromString((*stored)->spec);
  for (const v1::JobFile& file : spec.files()) {
    if (file.path() != spec.document()) continue;
    const auto bytes = controller_.assets().read(farm::hex_from_wire(file.sha256()));
    if (!bytes) return error_reply({grpc::StatusCode::DATA_LOSS, bytes.error().message});
    return text_reply(std::string(bytes->chars(), bytes->size()), "text/plain; charset=utf-8");
  }
  return error_reply({grpc::StatusCode::NOT_FOUND, "the job's document is not here"});
}

}  // namespace hyades::coordinator
