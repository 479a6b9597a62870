#pragma once

#include <atomic>

#include "coordinator/controller/controller.h"
#include "coordinator/services/answer.h"
#include "coordinator/services/executors.h"
#include "hyades/v1/jobs.grpc.pb.h"

namespace hyades::coordinator {

/// All methods of Jobs by bytes (raw.h).
using RawJobs = v1::Jobs::WithRawCallbackMethod_Submit<v1::Jobs::WithRawCallbackMethod_List<
    v1::Jobs::WithRawCallbackMethod_Get<v1::Jobs::WithRawCallbackMethod_Pause<
        v1::Jobs::WithRawCallbackMethod_Resume<v1::Jobs::WithRawCallbackMethod_Cancel<
            v1::Jobs::WithRawCallbackMethod_Retry<v1::Jobs::WithRawCallbackMethod_SetPriority<
                v1::Jobs::WithRawCallbackMethod_Delete<v1::Jobs::WithRawCallbackMethod_Explain<
                    v1::Jobs::WithRawCallbackMethod_Watch<v1::Jobs::WithRawCallbackMethod_Outputs<
                        v1::Jobs::WithRawCallbackMethod_Fetch<v1::Jobs::WithRawCallbackMethod_Film<
                            v1::Jobs::WithRawCallbackMethod_Logs<
                                v1::Jobs::WithRawCallbackMethod_ListTimeline<
                                    v1::Jobs::Service>>>>>>>>>>>>>>>>;

/// What clients ask about jobs (jobs_service.cpp, jobs_streams.cpp).
class JobsService final : public RawJobs {
 public:
  JobsService(Controller& controller, const Admission& admission, Executors& executors)
      : controller_(controller), admission_(admission), executors_(executors) {}

  using Context = grpc::CallbackServerContext;
  using Bytes = grpc::ByteBuffer;
  grpc::ServerUnaryReactor* Submit(Context* context, const Bytes* asked, Bytes* said) override;
  grpc::ServerUnaryReactor* List(Context* context, const Bytes* asked, Bytes* said) override;
  grpc::ServerUnaryReactor* Get(Context* context, const Bytes* asked, Bytes* said) override;
  grpc::ServerUnaryReactor* Pause(Context* context, const Bytes* asked, Bytes* said) override;
  grpc::ServerUnaryReactor* Resume(Context* context, const Bytes* asked, Bytes* said) override;
  grpc::ServerUnaryReactor* Cancel(Context* context, const Bytes* asked, Bytes* said) override;
  grpc::ServerUnaryReactor* Retry(Context* context, const Bytes* asked, Bytes* said) override;
  grpc::ServerUnaryReactor* SetPriority(Context* context, const Bytes* asked, Bytes* said) override;
  grpc::ServerUnaryReactor* Delete(Context* context, const Bytes* asked, Bytes* said) override;
  grpc::ServerUnaryReactor* Explain(Context* context, const Bytes* asked, Bytes* said) override;
  grpc::ServerUnaryReactor* ListTimeline(Context* context, const Bytes* asked,
                                         Bytes* said) override;
  grpc::ServerWriteReactor<Bytes>* Watch(Context* context, const Bytes* asked) override;
  grpc::ServerWriteReactor<Bytes>* Outputs(Context* context, const Bytes* asked) override;
  grpc::ServerWriteReactor<Bytes>* Fetch(Context* context, const Bytes* asked) override;
  grpc::ServerWriteReactor<Bytes>* Film(Context* context, const Bytes* asked) override;
  grpc::ServerWriteReactor<Bytes>* Logs(Context* context, const Bytes* asked) override;

 private:
  /// What a method does that takes a job and answers with how it is now.
  template <class Request>
  grpc::ServerUnaryReactor* steer(Call call, void (*what)(Controller&, const Request&, JobReply));

  Controller& controller_;
  const Admission& admission_;
  Executors& executors_;
  std::atomic<int> films_{0};  ///< on their way
};

}  // namespace hyades::coordinator
