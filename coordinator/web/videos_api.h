#pragma once

#include "coordinator/controller/controller.h"
#include "coordinator/services/executors.h"
#include "coordinator/web/router.h"

namespace hyades::coordinator {

/// Videos that people ask for besides those that their jobs make: who may steer a job may, as it
/// costs the coordinator work and writes among the job's outputs.
class VideosApi {
 public:
  VideosApi(Controller& controller, Executors& executors)
      : controller_(controller), executors_(executors) {}
  void add_routes(Router& router);

 private:
  WebReply list(uint64_t job);
  WebReply ask(const Caller& caller, uint64_t job, const VideoWish& wish);

  Controller& controller_;
  Executors& executors_;
};

}  // namespace hyades::coordinator
