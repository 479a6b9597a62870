#pragma once

#include "coordinator/brain/brain.h"
#include "coordinator/services/desks.h"
#include "coordinator/web/router.h"

namespace hyades::coordinator {

/// A job's finished files: told, shown, downloaded one by one or all together.
class OutputsApi {
 public:
  OutputsApi(Brain& brain, Desks& desks) : brain_(brain), desks_(desks) {}
  void add_routes(Router& router);

 private:
  WebReply list(uint64_t job);
  /// The headers Range and If-Range.
  struct WantedRange {
    std::string range;
    std::string if_tag;
  };
  WebReply file(uint64_t job, const std::string& path, const WantedRange& wanted, bool download);
  WebReply archive(uint64_t job);

  Brain& brain_;
  Desks& desks_;
};

/// All finished files of a job that are of use now: not those that wait for the video which is made
/// of them.
core::Result<std::vector<StoredOutput>> finished_files(Brain& brain, uint64_t job);

}  // namespace hyades::coordinator
