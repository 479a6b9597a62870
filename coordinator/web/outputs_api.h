#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "coordinator/controller/controller.h"
#include "coordinator/operations/executors.h"
#include "coordinator/web/router.h"
#include "hyades/v1/web.pb.h"

namespace hyades::coordinator {

/// A job's finished files: told, shown, downloaded one by one or all together.
class OutputsApi {
 public:
  OutputsApi(Controller& controller, Executors& executors)
      : controller_(controller), executors_(executors) {}
  void add_routes(Router& router);

 private:
  WebReply list(const v1::OutputsPageRequest& asked);
  WebReply file(const v1::OutputRequest& asked, const WebRequest& request);
  WebReply archive(uint64_t job);

  Controller& controller_;
  Executors& executors_;
};

/// Finished files, in the order in which they were finished.
struct OutputsPage {
  std::vector<StoredOutput> outputs;
  uint64_t after = 0;  ///< to ask for what comes behind them
  bool more = false;   ///< something may
};

/// Finished files of a job behind `after` that are of use now: not those that wait for the video
/// which is made of them. At most `limit`.
core::Result<OutputsPage> finished_files(Controller& controller, uint64_t job, uint64_t after,
                                         size_t limit);

}  // namespace hyades::coordinator
