#include "coordinator/web/jobs_api.h"

#include <utility>

#include "coordinator/controller/not_there.h"
#include "coordinator/services/ownership.h"
#include "coordinator/web/handing.h"
#include "coordinator/web/submission.h"
#include "farm/wire.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

constexpr uint32_t kLinesAtOnce = 1000;
constexpr uint32_t kMostJobs = 1000;  // on a page

/// What a question answers with, where its status is OK.
template <class Response, class Show>
WebReply reply_with(const grpc::Status& status, const Response& response, Show show) {
  return status.ok() ? json_reply(show(response)) : error_reply(status);
}

farm::Json job_with_frames(const v1::GetJobResponse& got) {
  farm::Json frames = farm::Json::array();
  for (const v1::Frame& frame : got.frames()) frames.push_back(farm::to_json(frame));
  return {{"job", farm::to_json(got.job())}, {"frames", std::move(frames)}, {"more", got.more()}};
}

farm::Json frames_alone(const v1::GetJobResponse& got) {
  farm::Json all = job_with_frames(got);
  all.erase("job");
  return all;
}

/// Frames of which state are asked for: unspecified without any; nothing (and answered) where there
/// is no such state.
std::optional<v1::FrameState> wanted_state(const WebRequest& request, const Answer& answer) {
  const auto asked = request.query.find("state");
  if (asked == request.query.end()) return v1::FRAME_STATE_UNSPECIFIED;
  for (int state = v1::FrameState_MIN; state <= v1::FrameState_MAX; ++state) {
    const auto known = static_cast<v1::FrameState>(state);
    if (known == v1::FRAME_STATE_UNSPECIFIED || farm::state_name(known) != asked->second) continue;
    return known;
  }
  answer(error_reply({grpc::StatusCode::INVALID_ARGUMENT,
                      "state: expected waiting, rendering, finishing, done or failed"}));
  return std::nullopt;
}

farm::Json reasons(const v1::ExplainResponse& why) {
  farm::Json all = farm::Json::array();
  for (const std::string& reason : why.reasons()) all.push_back(reason);
  return {{"reasons", std::move(all)}};
}

}  // namespace

void JobsApi::add_routes(Router& router) {
  add_questions(router);
  add_steering(router);
}

void JobsApi::add_questions(Router& router) {
  router.add("GET", "/api/v1/jobs", [this](const WebRequest& request, const Answer& answer) {
    v1::ListJobsRequest asked;
    const auto ended = query_flag(request, "ended", answer);
    if (!ended) return;
    asked.set_ended(*ended);
    const auto owner = request.query.find("owner");
    if (owner != request.query.end()) asked.set_owner(owner->second);
    const auto limit = query_within<uint32_t>(request, "limit", 1, kMostJobs, 0, answer);
    if (!limit) return;
    const auto before = query_number<uint64_t>(request, "before", 0, answer);
    if (!before) return;
    asked.set_limit(*limit);
    asked.set_before(*before);
    answer_by(executors_.rows, answer, [this, asked] { return list(asked); });
  });
  router.add("GET", "/api/v1/jobs/{job}",
             of_job([this](uint64_t job, const WebRequest& request, const Answer& answer) {
               std::optional<int32_t> after;
               if (!query_number_if_any(request, "after", after, answer)) return;
               answer_by(executors_.rows, answer, [this, job, after] {
                 v1::GetJobResponse got;
                 return reply_with(controller_.queries().get(job, after, got), got,
                                   job_with_frames);
               });
             }));
  router.add("GET", "/api/v1/jobs/{job}/frames",
             of_job([this](uint64_t job, const WebRequest& request, const Answer& answer) {
               std::optional<int32_t> after;
               if (!query_number_if_any(request, "after", after, answer)) return;
               const auto only = wanted_state(request, answer);
               if (!only) return;
               answer_by(executors_.rows, answer, [this, job, after, only = *only] {
                 v1::GetJobResponse got;
                 return reply_with(controller_.queries().get(job, after, got, only), got,
                                   frames_alone);
               });
             }));
  router.add("GET", "/api/v1/jobs/{job}/explain", of_job_by(executors_.rows, [this](uint64_t job) {
               v1::ExplainResponse why;
               return reply_with(controller_.diagnosis().explain(job, why), why, reasons);
             }));
  router.add("GET", "/api/v1/jobs/{job}/logs",
             of_job([this](uint64_t job, const WebRequest& request, const Answer& answer) {
               const auto after = query_number<uint64_t>(request, "after", 0, answer);
               if (!after) return;
               answer_by(executors_.rows, answer,
                         [this, job, from = *after] { return logs(job, from); });
             }));
  router.add("GET", "/api/v1/jobs/{job}/timeline",
             of_job([this](uint64_t job, const WebRequest& request, const Answer& answer) {
               const auto after = query_number<uint64_t>(request, "after", 0, answer);
               if (!after) return;
               const auto limit =
                   query_within<uint32_t>(request, "limit", 1, UINT32_MAX, 0, answer);
               if (!limit) return;
               v1::ListTimelineRequest asked;
               asked.set_job(job);
               asked.set_after(*after);
               asked.set_limit(*limit);
               answer_by(executors_.rows, answer, [this, asked] { return timeline(asked); });
             }));
  router.add("GET", "/api/v1/jobs/{job}/document",
             of_job_by(executors_.files, [this](uint64_t job) { return document(job); }));
}

void JobsApi::add_steering(Router& router) {
  router.add("POST", "/api/v1/jobs", [this](const WebRequest& request, const Answer& answer) {
    answer_by(executors_.files, answer, [this, body = request.body, caller = request.caller] {
      core::Result<v1::SubmitRequest> asked = core::Error{};
      {
        const std::unique_lock alone(large_, std::try_to_lock);
        if (!alone) return error_reply(crowded());
        asked = read_submission(body);
      }
      if (!asked) {
        return error_reply({grpc::StatusCode::INVALID_ARGUMENT, asked.error().message});
      }
      v1::SubmitResponse response;
      bool proven = false;
      grpc::Status done = name_owner(caller, *asked, proven);
      if (done.ok()) done = controller_.jobs().submit(*asked, proven, response);
      if (!done.ok()) return error_reply(done);
      WebReply reply =
          json_reply({{"job", farm::to_json(response.job())}, {"existed", response.existed()}});
      reply.status = response.existed() ? 200 : 201;
      return reply;
    });
  });
  using Steer = void (JobSteering::*)(uint64_t, JobReply);
  const std::pair<const char*, Steer> steers[] = {{"pause", &JobSteering::pause},
                                                  {"resume", &JobSteering::resume},
                                                  {"cancel", &JobSteering::cancel}};
  const auto told = [](const Answer& answer) {
    return [answer](const grpc::Status& done, const v1::Job& now) {
      answer(done.ok() ? json_reply(farm::to_json(now)) : error_reply(done));
    };
  };
  for (const auto& [name, what] : steers) {
    router.add("POST", std::string("/api/v1/jobs/{job}/") + name,
               of_job([this, told, steer = what](uint64_t job, const WebRequest& request,
                                                 const Answer& answer) {
                 const bool taken = executors_.rows.submit(
                     [this, told, steer, answer, job, caller = request.caller] {
                       const grpc::Status his = may_steer(controller_, caller, job);
                       his.ok() ? (controller_.steering().*steer)(job, told(answer))
                                : told(answer)(his, {});
                     });
                 if (!taken) answer(error_reply(crowded()));
               }));
  }
  router.add("PUT", "/api/v1/jobs/{job}/priority",
             of_job([this, told](uint64_t job, const WebRequest& request, const Answer& answer) {
               const auto json = farm::Json::parse(request.body, nullptr, false);
               const bool number = json.is_object() && json.contains("priority") &&
                                   json["priority"].is_number_integer();
               const int64_t priority = number ? json["priority"].get<int64_t>() : INT64_MAX;
               if (priority < INT32_MIN || priority > INT32_MAX) {
                 answer(error_reply({grpc::StatusCode::INVALID_ARGUMENT,
                                     "expected {\"priority\": a whole number}"}));
                 return;
               }
               const bool taken = executors_.rows.submit([this, told, answer, job, priority,
                                                          caller = request.caller] {
                 const grpc::Status his = may_steer(controller_, caller, job);
                 if (!his.ok()) return told(answer)(his, {});
                 controller_.steering().set_priority(job, static_cast<int>(priority), told(answer));
               });
               if (!taken) answer(error_reply(crowded()));
             }));
  router.add("POST", "/api/v1/jobs/{job}/retry",
             of_job([this](uint64_t job, const WebRequest& request, const Answer& answer) {
               answer_by(executors_.files, answer, [this, job, caller = request.caller] {
                 v1::Job now;
                 grpc::Status done = may_steer(controller_, caller, job);
                 if (done.ok()) done = controller_.jobs().retry(job, now);
                 return reply_with(done, now, [](const v1::Job& j) { return farm::to_json(j); });
               });
             }));
  router.add("DELETE", "/api/v1/jobs/{job}",
             of_job([this](uint64_t job, const WebRequest& request, const Answer& answer) {
               answer_by(executors_.files, answer, [this, job, caller = request.caller] {
                 grpc::Status done = may_steer(controller_, caller, job);
                 if (done.ok()) done = controller_.jobs().remove(job);
                 return done.ok() ? empty_reply(204) : error_reply(done);
               });
             }));
}

WebReply JobsApi::list(const v1::ListJobsRequest& request) {
  v1::ListJobsResponse response;
  const grpc::Status status = controller_.queries().list_open(request, response)
                                  ? grpc::Status::OK
                                  : controller_.queries().list(request, response);
  if (!status.ok()) return error_reply(status);
  farm::Json jobs = farm::Json::array();
  for (const v1::Job& job : response.jobs()) jobs.push_back(farm::to_json(job));
  return json_reply({{"jobs", std::move(jobs)}, {"next_before", response.next_before()}});
}

/// As many as are asked for, page by page; where nothing is said, all that there are.
WebReply JobsApi::timeline(v1::ListTimelineRequest asked) {
  farm::Json units = farm::Json::array();
  farm::Json steps = farm::Json::array();
  v1::ListTimelineResponse page;
  const uint32_t wanted = asked.limit() == 0 ? UINT32_MAX : asked.limit();
  for (uint32_t left = wanted;;) {
    asked.set_limit(left);
    page.Clear();
    const grpc::Status known = controller_.queries().timeline(asked, page);
    if (!known.ok()) return error_reply(known);
    for (const v1::TimelineStep& step : page.steps()) {
      const bool unit = step.kind() == v1::TimelineStep::KIND_RENDER;
      (unit ? units : steps).push_back(farm::to_json(step));
      asked.set_after(step.number());
    }
    left -= static_cast<uint32_t>(page.steps_size());
    if (!page.more() || left == 0) break;
  }
  return json_reply({{"units", std::move(units)},
                     {"steps", std::move(steps)},
                     {"after", asked.after()},
                     {"more", page.more()},
                     {"dropped", page.dropped()}});
}

WebReply JobsApi::logs(uint64_t job, uint64_t after) {
  const auto stored = controller_.store().state(job);
  if (!stored) return error_reply(farm::unavailable(stored.error()));
  if (!*stored) {
    return error_reply(no_job(job));
  }
  const auto lines = controller_.store().lines(job, after, kLinesAtOnce);
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
