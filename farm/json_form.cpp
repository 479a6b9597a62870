#include "farm/json_form.h"

#include <vector>

namespace hyades::farm {
namespace {

/// "JOB_STATE_DONE" without `prefix`, in small letters.
std::string word(const std::string& name, const std::string& prefix) {
  std::string text = name.starts_with(prefix) ? name.substr(prefix.size()) : "unknown";
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text == "unspecified" ? "unknown" : text;
}

}  // namespace

std::string state_name(v1::JobState state) { return word(v1::JobState_Name(state), "JOB_STATE_"); }
std::string state_name(v1::FrameState state) {
  return word(v1::FrameState_Name(state), "FRAME_STATE_");
}
std::string state_name(v1::WorkerState state) {
  return word(v1::WorkerState_Name(state), "WORKER_STATE_");
}
std::string level_name(v1::LogLevel level) { return word(v1::LogLevel_Name(level), "LOG_LEVEL_"); }
std::string role_name(v1::Role role) { return word(v1::Role_Name(role), "ROLE_"); }
std::optional<v1::Role> role_of(const std::string& name) {
  for (int role = v1::ROLE_VIEWER; role <= v1::ROLE_ADMIN; ++role) {
    if (name == role_name(static_cast<v1::Role>(role))) return static_cast<v1::Role>(role);
  }
  return std::nullopt;
}

Json to_json(const v1::Job& job) {
  Json json = {{"id", job.id()},
               {"name", job.name()},
               {"owner", job.owner()},
               {"owner_proven", job.owner_proven()},
               {"priority", job.priority()},
               {"state", state_name(job.state())},
               {"frames", job.frames()},
               {"frames_done", job.frames_done()},
               {"frames_failed", job.frames_failed()},
               {"samples", job.samples()},
               {"samples_done", job.samples_done()},
               {"leased", job.leased()},
               {"samples_per_second", job.samples_per_second()},
               {"seconds_left", job.seconds_left()},
               {"submitted_ms", job.submitted_ms()},
               {"ended_ms", job.ended_ms()},
               {"reason", job.reason()},
               {"max_workers", job.max_workers()},
               {"tags", std::vector<std::string>(job.tags().begin(), job.tags().end())},
               {"memory_bytes", job.memory_bytes()},
               {"max_attempts", job.max_attempts()},
               {"frame_order", word(v1::FrameOrder_Name(job.frame_order()), "FRAME_ORDER_")},
               {"core_seconds", job.core_seconds()},
               {"cost", job.cost()}};
  if (job.has_preview_frame()) json["preview_frame"] = job.preview_frame();
  return json;
}

Json to_json(const v1::Frame& frame) {
  return {{"id", frame.frame()},          {"state", state_name(frame.state())},
          {"samples", frame.samples()},   {"samples_done", frame.samples_done()},
          {"reason", frame.reason()},     {"worker_class", frame.worker_class()},
          {"restarts", frame.restarts()}, {"doubtful", frame.doubtful()}};
}

Json to_json(const v1::Worker& worker) {
  Json work = Json::array();
  for (const v1::WorkInHand& one : worker.work()) {
    work.push_back({{"job", one.job()}, {"frame", one.frame()}, {"units", one.units()}});
  }
  return {{"id", worker.id()},
          {"name", worker.name()},
          {"host", worker.host()},
          {"worker_class", worker.worker_class()},
          {"build", worker.build()},
          {"threads", worker.threads()},
          {"state", state_name(worker.state())},
          {"reason", worker.reason()},
          {"leased", worker.leased()},
          {"units_done", worker.units_done()},
          {"units_failed", worker.units_failed()},
          {"samples_done", worker.samples_done()},
          {"joined_ms", worker.joined_ms()},
          {"heard_ms", worker.heard_ms()},
          {"memory_bytes", worker.memory_bytes()},
          {"memory_limit_bytes", worker.memory_limit_bytes()},
          {"tags", std::vector<std::string>(worker.tags().begin(), worker.tags().end())},
          {"work", std::move(work)},
          {"cache_bytes", worker.cache_bytes()},
          {"cache_limit_bytes", worker.cache_limit_bytes()},
          {"cache_hits", worker.cache_hits()},
          {"cache_misses", worker.cache_misses()},
          {"samples_per_second", worker.samples_per_second()}};
}

Json to_json(const v1::TimelineStep& step) {
  Json json = {{"id", step.number()},
               {"kind", word(v1::TimelineStep::Kind_Name(step.kind()), "KIND_")},
               {"worker", step.worker()},
               {"thread", step.thread()}};
  const bool of_frame = step.kind() != v1::TimelineStep::KIND_VIDEO;
  const bool of_unit = of_frame && step.kind() != v1::TimelineStep::KIND_FINISH;
  if (of_frame) json["frame"] = step.unit().frame();
  if (of_unit) {
    const v1::PixelRect& tile = step.unit().tile();
    json["tile"] = {tile.x0(), tile.y0(), tile.x1(), tile.y1()};
    json["first_batch"] = step.unit().first_batch();
    json["batches"] = step.unit().batches();
  }
  json["begun_ms"] = 1e-3 * static_cast<double>(step.begun_us());
  json["ended_ms"] = 1e-3 * static_cast<double>(step.ended_us());
  return json;
}

Json to_json(const v1::LogLine& line) {
  Json json = {{"time_ms", line.time_ms()}, {"level", level_name(line.level())}};
  if (line.of_frame()) json["frame"] = line.frame();
  json["worker"] = line.worker();
  json["text"] = line.text();
  return json;
}

Json to_json(const v1::Token& token) {
  return {{"id", token.id()},
          {"name", token.name()},
          {"role", role_name(token.role())},
          {"created_ms", token.created_ms()},
          {"expires_ms", token.expires_ms()},
          {"used_ms", token.used_ms()},
          {"revoked_ms", token.revoked_ms()}};
}

Json to_json(const v1::AuditEntry& entry) {
  Json json = {{"time_ms", entry.time_ms()}, {"token_id", entry.token_id()},
               {"name", entry.name()},       {"role", role_name(entry.role())},
               {"address", entry.address()}, {"deed", entry.deed()},
               {"target", entry.target()},   {"result", entry.result()},
               {"detail", entry.detail()}};
  if (entry.times() > 1) json["times"] = entry.times();
  return json;
}

}  // namespace hyades::farm
