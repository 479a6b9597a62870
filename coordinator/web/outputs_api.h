#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/controller/controller.h"
#include "coordinator/services/executors.h"
#include "coordinator/web/router.h"

namespace hyades::coordinator {

/// A job's finished files: told, shown, downloaded one by one or all together.
class OutputsApi {
 public:
  OutputsApi(Controller& controller, Executors& executors)
      : controller_(controller), executors_(executors) {}
  void add_routes(Router& router);

 private:
  /// Which files of a job are asked for.
  struct ListAsked {
    uint64_t job = 0;
    uint64_t after = 0;
    uint32_t limit = 0;
    std::optional<int32_t> frame;  ///< only its own
  };
  WebReply list(const ListAsked& asked);
  /// The headers Range and If-Range.
  struct WantedRange {
    std::string range;
    std::string if_tag;
  };
  WebReply file(uint64_t job, const std::string& path, const WantedRange& wanted, bool download);
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
