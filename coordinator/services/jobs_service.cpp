#include "coordinator/services/jobs_service.h"

#include "coordinator/services/answer.h"

namespace hyades::coordinator {
grpc::ServerUnaryReactor* JobsService::Submit(Context* context, const v1::SubmitRequest* request,
                                              v1::SubmitResponse* response) {
  return answer(admission_, context, [&] { return brain_.submit(*request, *response); });
}

grpc::ServerUnaryReactor* JobsService::List(Context* context, const v1::ListJobsRequest* request,
                                            v1::ListJobsResponse* response) {
  return answer(admission_, context, [&] { return brain_.list(*request, *response); });
}

grpc::ServerUnaryReactor* JobsService::Get(Context* context, const v1::GetJobRequest* request,
                                           v1::GetJobResponse* response) {
  return answer(admission_, context, [&] { return brain_.get(request->job(), *response); });
}

grpc::ServerUnaryReactor* JobsService::Pause(Context* context, const v1::JobRequest* request,
                                             v1::JobResponse* response) {
  return answer(admission_, context,
                [&] { return brain_.pause(request->job(), *response->mutable_job()); });
}

grpc::ServerUnaryReactor* JobsService::Resume(Context* context, const v1::JobRequest* request,
                                              v1::JobResponse* response) {
  return answer(admission_, context,
                [&] { return brain_.resume(request->job(), *response->mutable_job()); });
}

grpc::ServerUnaryReactor* JobsService::Cancel(Context* context, const v1::JobRequest* request,
                                              v1::JobResponse* response) {
  return answer(admission_, context,
                [&] { return brain_.cancel(request->job(), *response->mutable_job()); });
}

grpc::ServerUnaryReactor* JobsService::Retry(Context* context, const v1::JobRequest* request,
                                             v1::JobResponse* response) {
  return answer(admission_, context,
                [&] { return brain_.retry(request->job(), *response->mutable_job()); });
}

grpc::ServerUnaryReactor* JobsService::SetPriority(Context* context,
                                                   const v1::SetPriorityRequest* request,
                                                   v1::JobResponse* response) {
  return answer(admission_, context, [&] {
    return brain_.set_priority(request->job(), request->priority(), *response->mutable_job());
  });
}

grpc::ServerUnaryReactor* JobsService::Delete(Context* context, const v1::JobRequest* request,
                                              v1::DeleteJobResponse*) {
  return answer(admission_, context, [&] { return brain_.remove(request->job()); });
}

grpc::ServerUnaryReactor* JobsService::Explain(Context* context, const v1::JobRequest* request,
                                               v1::ExplainResponse* response) {
  return answer(admission_, context, [&] { return brain_.explain(request->job(), *response); });
}

}  // namespace hyades::coordinator
