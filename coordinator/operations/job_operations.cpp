// What people ask about jobs, and have done with them.
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/controller/controller.h"
#include "coordinator/operations/operation.h"
#include "coordinator/operations/ownership.h"

namespace hyades::coordinator {
namespace {

// To look.

bool list_open(Backend& at, const v1::ListJobsRequest& request, v1::ListJobsResponse& response) {
  return at.controller.queries().list_open(request, response);
}

grpc::Status list(Backend& at, const v1::ListJobsRequest& request, v1::ListJobsResponse& response) {
  return list_open(at, request, response) ? grpc::Status::OK
                                          : at.controller.queries().list(request, response);
}

std::optional<int32_t> after(const v1::GetJobRequest& request) {
  return request.has_after() ? std::optional(request.after()) : std::nullopt;
}

bool get_open(Backend& at, const v1::GetJobRequest& request, v1::GetJobResponse& response) {
  return at.controller.queries().get_open(request.job(), after(request), response, request.state());
}

grpc::Status get(Backend& at, const v1::GetJobRequest& request, v1::GetJobResponse& response) {
  return at.controller.queries().get(request.job(), after(request), response, request.state());
}

HttpForm frames_alone(const v1::GetJobRequest&, const v1::GetJobResponse& response) {
  farm::Json json = farm::to_json(response);
  json.erase("job");
  return {std::move(json)};
}

bool explain_open(Backend& at, const v1::JobRequest& request, v1::ExplainResponse& response) {
  return at.controller.diagnosis().explain_open(request.job(), response);
}

grpc::Status explain(Backend& at, const v1::JobRequest& request, v1::ExplainResponse& response) {
  return at.controller.diagnosis().explain(request.job(), response);
}

grpc::Status timeline(Backend& at, const v1::ListTimelineRequest& request,
                      v1::ListTimelineResponse& response) {
  return at.controller.queries().timeline(request, response);
}

/// As many steps as are asked for, page by page; where nothing is said, all that there are.
grpc::Status whole_timeline(Backend& at, const v1::ListTimelineRequest& request,
                            v1::ListTimelineResponse& all) {
  v1::ListTimelineRequest next = request;
  next.set_limit(request.limit() == 0 ? UINT32_MAX : request.limit());
  v1::ListTimelineResponse page;
  do {
    page.Clear();
    const grpc::Status known = at.controller.queries().timeline(next, page);
    if (!known.ok()) return known;
    if (!page.steps().empty()) next.set_after(page.steps().rbegin()->number());
    next.set_limit(next.limit() - static_cast<uint32_t>(page.steps_size()));
    all.mutable_steps()->MergeFrom(page.steps());
  } while (page.more() && next.limit() > 0);
  all.set_more(page.more());
  all.set_dropped(page.dropped());
  return grpc::Status::OK;
}

/// A tile only where the step is of a unit; times in milliseconds, with parts.
farm::Json step_form(const v1::TimelineStep& step) {
  farm::Json json = {{"id", step.number()},
                     {"kind", farm::enum_word(*v1::TimelineStep::Kind_descriptor(), step.kind())},
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

HttpForm timeline_form(const v1::ListTimelineRequest& request,
                       const v1::ListTimelineResponse& response) {
  farm::Json units = farm::Json::array();
  farm::Json steps = farm::Json::array();
  for (const v1::TimelineStep& step : response.steps()) {
    (step.kind() == v1::TimelineStep::KIND_RENDER ? units : steps).push_back(step_form(step));
  }
  const uint64_t last =
      response.steps().empty() ? request.after() : response.steps().rbegin()->number();
  return {{{"units", std::move(units)},
           {"steps", std::move(steps)},
           {"after", last},
           {"more", response.more()},
           {"dropped", response.dropped()}}};
}

// To submit.

const BodyForm kFile = {{{"path", true}, {"sha256", true}, {"size", true}}};
const BodyForm kFrames = {{{"first", true}, {"last", true}, {"step"}}};
/// The spec's fields and what else is asked for stand side by side.
BodyForm make_submission_form() {
  BodyForm form = {.fields = {{"spec.name", true},
                              {"spec.document", true},
                              {"spec.samples"},
                              {"spec.files", true, &kFile},
                              {"spec.frames", false, &kFrames}},
                   .no_object = "expected a JSON object: the submission"};
  const auto& type = *v1::SubmitRequest::descriptor();
  for (int i = 0; i < type.field_count(); ++i) {
    const std::string& name = type.field(i)->name();
    if (name != "spec" && name != "login") form.fields.push_back({name.c_str()});
  }
  return form;
}
const BodyForm* submission_form() {
  static const BodyForm form = make_submission_form();
  return &form;
}

grpc::Status submit(Backend& at, v1::SubmitRequest& request, v1::SubmitResponse& response,
                    const Caller& caller) {
  bool proven = false;
  const grpc::Status owned = name_owner(caller, request, proven);
  return owned.ok() ? at.controller.jobs().submit(request, proven, response) : owned;
}

HttpForm submitted(const v1::SubmitRequest&, const v1::SubmitResponse& response) {
  return {farm::to_json(response), response.existed() ? 200U : 201U};
}

// To steer what one has submitted.

JobReply reply(const Respond<v1::JobResponse>& respond) {
  return [respond](const grpc::Status& done, const v1::Job& now) {
    v1::JobResponse response;
    *response.mutable_job() = now;
    respond(done, response);
  };
}

template <auto what>
void steer_job(Backend& at, const v1::JobRequest& request, const Respond<v1::JobResponse>& respond,
               const Caller& caller) {
  (at.controller.steering().*what)(request.job(), caller.name, reply(respond));
}

const BodyForm kPriority = {{{"priority", true}}, "expected {\"priority\": a whole number}"};

void set_priority(Backend& at, const v1::SetPriorityRequest& request,
                  const Respond<v1::JobResponse>& respond, const Caller& caller) {
  at.controller.steering().set_priority(request.job(), request.priority(), caller.name,
                                        reply(respond));
}

void retry(Backend& at, const v1::JobRequest& request, const Respond<v1::JobResponse>& respond) {
  at.controller.jobs().retry(request.job(), reply(respond));
}

grpc::Status remove(Backend& at, const v1::JobRequest& request, v1::DeleteJobResponse&) {
  return at.controller.jobs().remove(request.job());
}

// Videos that people ask for besides those that their jobs make: who may steer a job may, as it
// costs the coordinator work and writes among the job's outputs.

v1::Video to_wire(const RequestedVideo& asked) {
  v1::Video video;
  video.set_id(asked.number);
  video.set_file(asked.video.file);
  video.set_pictures(asked.video.pictures);
  video.set_frames(asked.frames.numbers.size());
  video.set_rate(asked.frames.rate);
  switch (asked.state) {
    case RequestedVideo::State::waiting:
      video.set_state(v1::VIDEO_STATE_WAITING);
      break;
    case RequestedVideo::State::making:
      video.set_state(v1::VIDEO_STATE_MAKING);
      break;
    case RequestedVideo::State::done:
      video.set_state(v1::VIDEO_STATE_DONE);
      break;
    case RequestedVideo::State::failed:
      video.set_state(v1::VIDEO_STATE_FAILED);
      break;
  }
  video.set_reason(asked.reason);
  return video;
}

grpc::Status list_videos(Backend& at, const v1::JobRequest& request,
                         v1::ListVideosResponse& response) {
  std::vector<RequestedVideo> videos;
  const grpc::Status known = at.controller.videos().asked(request.job(), videos);
  for (const RequestedVideo& video : videos) *response.add_videos() = to_wire(video);
  return known;
}

const BodyForm kVideo = {.fields = {{"file"}, {"pictures"}, {"rate"}},
                         .no_object = "expected an object: {\"file\": \"video.mp4\"}",
                         .may_be_empty = true};

grpc::Status make_video(Backend& at, const v1::MakeVideoRequest& request,
                        v1::MakeVideoResponse& response) {
  RequestedVideo video;
  const grpc::Status taken = at.controller.videos().ask(
      request.job(), {request.file(), request.pictures(), request.rate()}, video);
  if (taken.ok()) *response.mutable_video() = to_wire(video);
  return taken;
}

Rule may_look(const char* action) { return {action, v1::ROLE_VIEWER}; }
Rule may_steer_job(const char* action) { return {action, v1::ROLE_SUBMITTER, false, true, true}; }
constexpr Rule kMaySubmit = {"job.submit", v1::ROLE_SUBMITTER, false, true};

}  // namespace

// clang-format off
std::vector<Operation> job_operations() {
  using enum Runs;
  return {
      {may_look("job.list"), "Jobs/List", in_store, Handler(list, list_open),
       {{"GET /api/v1/jobs", {{"ended"}, {"owner"}, {"limit", 1, 1000}, {"before"}}}}},
      {may_look("job.get"), "Jobs/Get", in_store, Handler(get, get_open),
       {{"GET /api/v1/jobs/{job}", {{"after"}}},
        {.path = "GET /api/v1/jobs/{job}/frames", .query = {{"state"}, {"after"}}, .show = frames_alone}}},
      {may_look("job.watch"), "Jobs/Watch", in_store, {}, {{"GET /api/v1/jobs/{job}/events"}}},
      {may_look("job.explain"), "Jobs/Explain", in_store, Handler(explain, explain_open),
       {{"GET /api/v1/jobs/{job}/explain"}}},
      {may_look("job.logs"), "Jobs/Logs", in_store, {}, {{"GET /api/v1/jobs/{job}/logs", {{"after"}}}}},
      {may_look("job.timeline"), "Jobs/ListTimeline", in_store, timeline,
       {{.path = "GET /api/v1/jobs/{job}/timeline", .query = {{"after"}, {"limit", 1, UINT32_MAX}},
         .show = timeline_form, .handle = whole_timeline, .runs = in_store}}},
      {may_look("job.document"), "", in_files, {}, {{"GET /api/v1/jobs/{job}/document"}}},
      {may_look("job.outputs"), "Jobs/Outputs", in_store, {},
       {{"GET /api/v1/jobs/{job}/outputs", {{"after"}, {"limit", 1, 10'000}, {"frame"}}}}},
      {may_look("job.outputs"), "", in_store, list_videos, {{"GET /api/v1/jobs/{job}/videos"}}},
      {may_look("job.fetch"), "Jobs/Fetch", in_files, {},
       {{"GET /api/v1/jobs/{job}/outputs/{path...}", {{"download"}}}, {"GET /api/v1/jobs/{job}/archive.zip"}}},
      {may_look("job.film"), "Jobs/Film", in_files, {},
       {{"GET /api/v1/jobs/{job}/frames/{frame}/picture",
         {{"format"}, {"width", 16, 8192}, {"layer"}, {"mask"}}}}},
      {kMaySubmit, "Jobs/Submit", in_files, submit,
       {{.path = "POST /api/v1/jobs", .body = submission_form(), .show = submitted}}, farm::kMaxMessageBytes},
      {may_steer_job("job.pause"), "Jobs/Pause", in_store, steer_job<&JobSteering::pause>,
       {{.path = "POST /api/v1/jobs/{job}/pause", .only = "job"}}},
      {may_steer_job("job.resume"), "Jobs/Resume", in_store, steer_job<&JobSteering::resume>,
       {{.path = "POST /api/v1/jobs/{job}/resume", .only = "job"}}},
      {may_steer_job("job.cancel"), "Jobs/Cancel", in_store, steer_job<&JobSteering::cancel>,
       {{.path = "POST /api/v1/jobs/{job}/cancel", .only = "job"}}},
      {may_steer_job("job.retry"), "Jobs/Retry", in_files, retry,
       {{.path = "POST /api/v1/jobs/{job}/retry", .only = "job"}}},
      {may_steer_job("job.priority"), "Jobs/SetPriority", in_store, set_priority,
       {{.path = "PUT /api/v1/jobs/{job}/priority", .body = &kPriority, .only = "job"}}},
      {may_steer_job("job.video"), "", in_files, make_video,
       {{.path = "POST /api/v1/jobs/{job}/videos", .body = &kVideo, .only = "video", .status = 202}}},
      {may_steer_job("job.delete"), "Jobs/Delete", in_files, remove,
       {{.path = "DELETE /api/v1/jobs/{job}", .status = 204}}},
  };
}
// clang-format on

}  // namespace hyades::coordinator
