#include "coordinator/services/jobs_service.h"

#include <utility>

#include "coordinator/services/answer.h"
#include "coordinator/services/ownership.h"

namespace hyades::coordinator {
namespace {

std::optional<int32_t> after(const v1::GetJobRequest& request) {
  return request.has_after() ? std::optional(request.after()) : std::nullopt;
}

}  // namespace

grpc::ServerUnaryReactor* JobsService::Submit(Context* context, const Bytes* asked, Bytes* said) {
  return answer_by<v1::SubmitRequest, v1::SubmitResponse>(
      executors_.files, {admission_, "Jobs/Submit", context, asked, said},
      [this](v1::SubmitRequest& request, v1::SubmitResponse& response, const Caller& caller) {
        bool proven = false;
        const grpc::Status owned = name_owner(caller, request, proven);
        return owned.ok() ? controller_.jobs().submit(request, proven, response) : owned;
      },
      farm::kMaxMessageBytes);
}

grpc::ServerUnaryReactor* JobsService::List(Context* context, const Bytes* asked, Bytes* said) {
  return answer_or_by<v1::ListJobsRequest, v1::ListJobsResponse>(
      executors_.rows, {admission_, "Jobs/List", context, asked, said},
      [this](const v1::ListJobsRequest& request, v1::ListJobsResponse& response) {
        return controller_.queries().list_open(request, response);
      },
      [this](const v1::ListJobsRequest& request, v1::ListJobsResponse& response) {
        return controller_.queries().list(request, response);
      });
}

grpc::ServerUnaryReactor* JobsService::Get(Context* context, const Bytes* asked, Bytes* said) {
  return answer_or_by<v1::GetJobRequest, v1::GetJobResponse>(
      executors_.rows, {admission_, "Jobs/Get", context, asked, said},
      [this](const v1::GetJobRequest& request, v1::GetJobResponse& response) {
        return controller_.queries().get_open(request.job(), after(request), response,
                                              request.state());
      },
      [this](const v1::GetJobRequest& request, v1::GetJobResponse& response) {
        return controller_.queries().get(request.job(), after(request), response, request.state());
      });
}

grpc::ServerUnaryReactor* JobsService::Explain(Context* context, const Bytes* asked, Bytes* said) {
  return answer_or_by<v1::JobRequest, v1::ExplainResponse>(
      executors_.rows, {admission_, "Jobs/Explain", context, asked, said},
      [this](const v1::JobRequest& request, v1::ExplainResponse& response) {
        return controller_.diagnosis().explain_open(request.job(), response);
      },
      [this](const v1::JobRequest& request, v1::ExplainResponse& response) {
        return controller_.diagnosis().explain(request.job(), response);
      });
}

grpc::ServerUnaryReactor* JobsService::ListTimeline(Context* context, const Bytes* asked,
                                                    Bytes* said) {
  return answer_by<v1::ListTimelineRequest, v1::ListTimelineResponse>(
      executors_.rows, {admission_, "Jobs/ListTimeline", context, asked, said},
      [this](const v1::ListTimelineRequest& request, v1::ListTimelineResponse& response) {
        return controller_.queries().timeline(request, response);
      });
}

template <class Request>
grpc::ServerUnaryReactor* JobsService::steer(Call call,
                                             void (*what)(Controller&, const Request&, JobReply)) {
  Request request;
  grpc::Status status = call.admit();
  if (status.ok()) status = parse(*call.asked, farm::kMaxRequestBytes, request);
  if (!status.ok()) {
    call.reactor->Finish(status);
  } else if (!executors_.rows.submit([this, call, what, request = std::move(request)] {
               const auto told = [call, request](const grpc::Status& done, const v1::Job& now) {
                 v1::JobResponse response;
                 *response.mutable_job() = now;
                 call.note(done, request, response);
                 call.finish(done, response);
               };
               const grpc::Status his = may_steer(controller_, call.caller, request.job());
               his.ok() ? what(controller_, request, told) : told(his, {});
             })) {
    call.reactor->Finish(crowded());
  }
  return call.reactor;
}

grpc::ServerUnaryReactor* JobsService::Pause(Context* context, const Bytes* asked, Bytes* said) {
  return steer<v1::JobRequest>(
      {admission_, "Jobs/Pause", context, asked, said},
      [](Controller& controller, const v1::JobRequest& request, JobReply then) {
        controller.steering().pause(request.job(), std::move(then));
      });
}

grpc::ServerUnaryReactor* JobsService::Resume(Context* context, const Bytes* asked, Bytes* said) {
  return steer<v1::JobRequest>(
      {admission_, "Jobs/Resume", context, asked, said},
      [](Controller& controller, const v1::JobRequest& request, JobReply then) {
        controller.steering().resume(request.job(), std::move(then));
      });
}

grpc::ServerUnaryReactor* JobsService::Cancel(Context* context, const Bytes* asked, Bytes* said) {
  return steer<v1::JobRequest>(
      {admission_, "Jobs/Cancel", context, asked, said},
      [](Controller& controller, const v1::JobRequest& request, JobReply then) {
        controller.steering().cancel(request.job(), std::move(then));
      });
}

grpc::ServerUnaryReactor* JobsService::SetPriority(Context* context, const Bytes* asked,
                                                   Bytes* said) {
  return steer<v1::SetPriorityRequest>(
      {admission_, "Jobs/SetPriority", context, asked, said},
      [](Controller& controller, const v1::SetPriorityRequest& request, JobReply then) {
        controller.steering().set_priority(request.job(), request.priority(), std::move(then));
      });
}

grpc::ServerUnaryReactor* JobsService::Retry(Context* context, const Bytes* asked, Bytes* said) {
  return answer_by<v1::JobRequest, v1::JobResponse>(
      executors_.files, {admission_, "Jobs/Retry", context, asked, said},
      [this](const v1::JobRequest& request, v1::JobResponse& response, const Caller& caller) {
        const grpc::Status his = may_steer(controller_, caller, request.job());
        return his.ok() ? controller_.jobs().retry(request.job(), *response.mutable_job()) : his;
      });
}

grpc::ServerUnaryReactor* JobsService::Delete(Context* context, const Bytes* asked, Bytes* said) {
  return answer_by<v1::JobRequest, v1::DeleteJobResponse>(
      executors_.files, {admission_, "Jobs/Delete", context, asked, said},
      [this](const v1::JobRequest& request, v1::DeleteJobResponse&, const Caller& caller) {
        const grpc::Status his = may_steer(controller_, caller, request.job());
        return his.ok() ? controller_.jobs().remove(request.job()) : his;
      });
}

}  // namespace hyades::coordinator
