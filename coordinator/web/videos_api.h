#pragma once

#include "coordinator/brain/brain.h"
#include "coordinator/services/desks.h"
#include "coordinator/web/router.h"

namespace hyades::coordinator {

/// Videos that people ask for besides those that their jobs make: who may steer a job may, as it
/// costs the coordinator work and writes among the job's outputs.
class VideosApi {
 public:
  VideosApi(Brain& brain, Desks& desks) : brain_(brain), desks_(desks) {}
  void add_routes(Router& router);

 private:
  WebReply list(uint64_t job);
  WebReply ask(const Caller& caller, uint64_t job, const VideoWish& wish);

  Brain& brain_;
  Desks& desks_;
};

}  // namespace hyades::coordinator
