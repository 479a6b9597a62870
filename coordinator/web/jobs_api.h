#pragma once

#include <mutex>

#include "coordinator/controller/controller.h"
#include "coordinator/services/executors.h"
#include "coordinator/web/router.h"

namespace hyades::coordinator {

/// What people ask about jobs, and have done with them.
class JobsApi {
 public:
  JobsApi(Controller& controller, Executors& executors)
      : controller_(controller), executors_(executors) {}
  void add_routes(Router& router);

 private:
  void add_questions(Router& router);
  void add_steering(Router& router);
  WebReply list(const v1::ListJobsRequest& request);
  WebReply timeline(v1::ListTimelineRequest asked);
  WebReply logs(uint64_t job, uint64_t after);
  WebReply document(uint64_t job);

  Controller& controller_;
  Executors& executors_;
  std::mutex large_;  ///< held while a submission is looked at
};

}  // namespace hyades::coordinator
