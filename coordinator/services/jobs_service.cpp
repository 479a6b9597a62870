#include "coordinator/services/jobs_service.h"

#include <utility>

#include "coordinator/services/answer.h"

namespace hyades::coordinator {
namespace {

std::optional<int32_t> after(const v1::GetJobRequest& request) {
  return request.has_after() ? std::optional(request.after()) : std::nullopt;
}

}  // namespace

grpc::ServerUnaryReactor* JobsService::Submit(Context* context, const Bytes* asked, Bytes* said) {
  return answer_by<v1::SubmitRequest, v1::SubmitResponse>(
      desks_.files, {admission_, context, asked, said},
      [this](const v1::SubmitRequest& request, v1::SubmitResponse& response) {
        return brain_.submit(request, response);
      },
      farm::kMaxMessageBytes);
}

grpc::ServerUnaryReactor* JobsService::List(Context* context, const Bytes* asked, Bytes* said) {
  return answer_or_by<v1::ListJobsRequest, v1::ListJobsResponse>(
      desks_.rows, {admission_, context, asked, said},
      [this](const v1::ListJobsRequest& request, v1::ListJobsResponse& response) {
        return brain_.list_open(request, response);
      },
      [this](const v1::ListJobsRequest& request, v1::ListJobsResponse& response) {
        return brain_.list(request, response);
      });
}

grpc::ServerUnaryReactor* JobsService::Get(Context* context, const Bytes* asked, Bytes* said) {
  return answer_or_by<v1::GetJobRequest, v1::GetJobResponse>(
      desks_.rows, {admission_, context, asked, said},
      [this](const v1::GetJobRequest& request, v1::GetJobResponse& response) {
        return brain_.get_open(request.job(), after(request), response, request.state());
      },
      [this](const v1::GetJobRequest& request, v1::GetJobResponse& response) {
        return brain_.get(request.job(), after(request), response, request.state());
      });
}

grpc::ServerUnaryReactor* JobsService::Explain(Context* context, const Bytes* asked, Bytes* said) {
  return answer_or_by<v1::JobRequest, v1::ExplainResponse>(
      desks_.rows, {admission_, context, asked, said},
      [this](const v1::JobRequest& request, v1::ExplainResponse& response) {
        return brain_.explain_open(request.job(), response);
      },
      [this](const v1::JobRequest& request, v1::ExplainResponse& response) {
        return brain_.explain(request.job(), response);
      });
}

grpc::ServerUnaryReactor* JobsService::ListTimeline(Context* context, const Bytes* asked,
                                                    Bytes* said) {
  return answer_by<v1::ListTimelineRequest, v1::ListTimelineResponse>(
      desks_.rows, {admission_, context, asked, said},
      [this](const v1::ListTimelineRequest& request, v1::ListTimelineResponse& response) {
        return brain_.timeline(request, response);
      });
}

template <class Request>
grpc::ServerUnaryReactor* JobsService::steer(Context* context, const Bytes* asked, Bytes* said,
                                             void (*what)(Brain&, const Request&, Brain::Told)) {
  const Call call{admission_, context, asked, said};
  Request request;
  grpc::Status status = admission_.check(*context);
  if (status.ok()) status = parse(*asked, farm::kMaxRequestBytes, request);
  if (!status.ok()) {
    call.reactor->Finish(status);
  } else if (!desks_.rows.hand([this, call, what, request = std::move(request)] {
               what(brain_, request, [call](const grpc::Status& done, const v1::Job& now) {
                 v1::JobResponse response;
                 *response.mutable_job() = now;
                 call.finish(done, response);
               });
             })) {
    call.reactor->Finish(crowded());
  }
  return call.reactor;
}

grpc::ServerUnaryReactor* JobsService::Pause(Context* context, const Bytes* asked, Bytes* said) {
  return steer<v1::JobRequest>(context, asked, said,
                               [](Brain& brain, const v1::JobRequest& request, Brain::Told then) {
                                 brain.pause(request.job(), std::move(then));
                               });
}

grpc::ServerUnaryReactor* JobsService::Resume(Context* context, const Bytes* asked, Bytes* said) {
  return steer<v1::JobRequest>(context, asked, said,
                               [](Brain& brain, const v1::JobRequest& request, Brain::Told then) {
                                 brain.resume(request.job(), std::move(then));
                               });
}

grpc::ServerUnaryReactor* JobsService::Cancel(Context* context, const Bytes* asked, Bytes* said) {
  return steer<v1::JobRequest>(context, asked, said,
                               [](Brain& brain, const v1::JobRequest& request, Brain::Told then) {
                                 brain.cancel(request.job(), std::move(then));
                               });
}

grpc::ServerUnaryReactor* JobsService::SetPriority(Context* context, const Bytes* asked,
                                                   Bytes* said) {
  return steer<v1::SetPriorityRequest>(
      context, asked, said,
      [](Brain& brain, const v1::SetPriorityRequest& request, Brain::Told then) {
        brain.set_priority(request.job(), request.priority(), std::move(then));
      });
}

grpc::ServerUnaryReactor* JobsService::Retry(Context* context, const Bytes* asked, Bytes* said) {
  return answer_by<v1::JobRequest, v1::JobResponse>(
      desks_.files, {admission_, context, asked, said},
      [this](const v1::JobRequest& request, v1::JobResponse& response) {
        return brain_.retry(request.job(), *response.mutable_job());
      });
}

grpc::ServerUnaryReactor* JobsService::Delete(Context* context, const Bytes* asked, Bytes* said) {
  return answer_by<v1::JobRequest, v1::DeleteJobResponse>(
      desks_.files, {admission_, context, asked, said},
      [this](const v1::JobRequest& request, v1::DeleteJobResponse&) {
        return brain_.remove(request.job());
      });
}

}  // namespace hyades::coordinator
