#include "coordinator/services/jobs_service.h"

#include "coordinator/services/answer.h"

namespace hyades::coordinator {

grpc::ServerUnaryReactor* JobsService::Submit(Context* context, const Bytes* asked, Bytes* said) {
  return answer<v1::SubmitRequest, v1::SubmitResponse>(
      admission_, context, asked, said,
      [&](const v1::SubmitRequest& request, v1::SubmitResponse& response) {
        return brain_.submit(request, response);
      },
      farm::kMaxMessageBytes);
}

grpc::ServerUnaryReactor* JobsService::List(Context* context, const Bytes* asked, Bytes* said) {
  return answer<v1::ListJobsRequest, v1::ListJobsResponse>(
      admission_, context, asked, said,
      [&](const v1::ListJobsRequest& request, v1::ListJobsResponse& response) {
        return brain_.list(request, response);
      });
}

grpc::ServerUnaryReactor* JobsService::Get(Context* context, const Bytes* asked, Bytes* said) {
  return answer<v1::GetJobRequest, v1::GetJobResponse>(
      admission_, context, asked, said,
      [&](const v1::GetJobRequest& request, v1::GetJobResponse& response) {
        const auto after = request.has_after() ? std::optional(request.after()) : std::nullopt;
        return brain_.get(request.job(), after, response);
      });
}

grpc::ServerUnaryReactor* JobsService::steer(Context* context, const Bytes* asked, Bytes* said,
                                             grpc::Status (Brain::*what)(uint64_t, v1::Job&)) {
  return answer<v1::JobRequest, v1::JobResponse>(
      admission_, context, asked, said,
      [&](const v1::JobRequest& request, v1::JobResponse& response) {
        return (brain_.*what)(request.job(), *response.mutable_job());
      });
}

grpc::ServerUnaryReactor* JobsService::Pause(Context* context, const Bytes* asked, Bytes* said) {
  return steer(context, asked, said, &Brain::pause);
}

grpc::ServerUnaryReactor* JobsService::Resume(Context* context, const Bytes* asked, Bytes* said) {
  return steer(context, asked, said, &Brain::resume);
}

grpc::ServerUnaryReactor* JobsService::Cancel(Context* context, const Bytes* asked, Bytes* said) {
  return steer(context, asked, said, &Brain::cancel);
}

grpc::ServerUnaryReactor* JobsService::Retry(Context* context, const Bytes* asked, Bytes* said) {
  return steer(context, asked, said, &Brain::retry);
}

grpc::ServerUnaryReactor* JobsService::SetPriority(Context* context, const Bytes* asked,
                                                   Bytes* said) {
  return answer<v1::SetPriorityRequest, v1::JobResponse>(
      admission_, context, asked, said,
      [&](const v1::SetPriorityRequest& request, v1::JobResponse& response) {
        return brain_.set_priority(request.job(), request.priority(), *response.mutable_job());
      });
}

grpc::ServerUnaryReactor* JobsService::Delete(Context* context, const Bytes* asked, Bytes* said) {
  return answer<v1::JobRequest, v1::DeleteJobResponse>(
      admission_, context, asked, said, [&](const v1::JobRequest& request, v1::DeleteJobResponse&) {
        return brain_.remove(request.job());
      });
}

grpc::ServerUnaryReactor* JobsService::Explain(Context* context, const Bytes* asked, Bytes* said) {
  return answer<v1::JobRequest, v1::ExplainResponse>(
      admission_, context, asked, said,
      [&](const v1::JobRequest& request, v1::ExplainResponse& response) {
        return brain_.explain(request.job(), response);
      });
}

}  // namespace hyades::coordinator
