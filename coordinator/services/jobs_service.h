#pragma once

#include "coordinator/brain/brain.h"
#include "coordinator/services/admission.h"
#include "hyades/v1/jobs.grpc.pb.h"

namespace hyades::coordinator {

/// What clients ask about jobs (jobs_service.cpp, jobs_streams.cpp).
class JobsService final : public v1::Jobs::CallbackService {
 public:
  JobsService(Brain& brain, const Admission& admission) : brain_(brain), admission_(admission) {}

  using Context = grpc::CallbackServerContext;
  grpc::ServerUnaryReactor* Submit(Context* context, const v1::SubmitRequest* request,
                                   v1::SubmitResponse* response) override;
  grpc::ServerUnaryReactor* List(Context* context, const v1::ListJobsRequest* request,
                                 v1::ListJobsResponse* response) override;
  grpc::ServerUnaryReactor* Get(Context* context, const v1::GetJobRequest* request,
                                v1::GetJobResponse* response) override;
  grpc::ServerUnaryReactor* Pause(Context* context, const v1::JobRequest* request,
                                  v1::JobResponse* response) override;
  grpc::ServerUnaryReactor* Resume(Context* context, const v1::JobRequest* request,
                                   v1::JobResponse* response) override;
  grpc::ServerUnaryReactor* Cancel(Context* context, const v1::JobRequest* request,
                                   v1::JobResponse* response) override;
  grpc::ServerUnaryReactor* Retry(Context* context, const v1::JobRequest* request,
                                  v1::JobResponse* response) override;
  grpc::ServerUnaryReactor* SetPriority(Context* context, const v1::SetPriorityRequest* request,
                                        v1::JobResponse* response) override;
  grpc::ServerUnaryReactor* Delete(Context* context, const v1::JobRequest* request,
                                   v1::DeleteJobResponse* response) override;
  grpc::ServerUnaryReactor* Explain(Context* context, const v1::JobRequest* request,
                                    v1::ExplainResponse* response) override;
  grpc::ServerWriteReactor<v1::WatchEvent>* Watch(Context* context,
                                                  const v1::WatchRequest* request) override;
  grpc::ServerWriteReactor<v1::OutputFile>* Outputs(Context* context,
                                                    const v1::OutputsRequest* request) override;
  grpc::ServerWriteReactor<v1::Chunk>* Fetch(Context* context,
                                             const v1::FetchRequest* request) override;
  grpc::ServerWriteReactor<v1::FilmPart>* Film(Context* context,
                                               const v1::FilmRequest* request) override;
  grpc::ServerWriteReactor<v1::LogLine>* Logs(Context* context,
                                              const v1::LogsRequest* request) override;

 private:
  Brain& brain_;
  const Admission& admission_;
};

}  // namespace hyades::coordinator
