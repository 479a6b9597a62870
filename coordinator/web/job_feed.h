#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "coordinator/controller/controller.h"
#include "coordinator/operations/executors.h"
#include "coordinator/web/exchange.h"
#include "coordinator/web/live_readers.h"
#include "core/base/mutex.h"
#include "farm/json_form.h"

namespace hyades::coordinator {

/// What happens to one job (openapi.yaml, /jobs/{job}/events), told to those who know how the job
/// is. A job may have a million frames: everything is read and told page by page.
class JobFeed final : public std::enable_shared_from_this<JobFeed> {
 public:
  /// `controller` and `executors` outlive it.
  JobFeed(Controller& controller, Executors& executors, uint64_t job)
      : controller_(controller), executors_(executors), job_(job) {}
  ~JobFeed();
  JobFeed(const JobFeed&) = delete;
  JobFeed& operator=(const JobFeed&) = delete;

  /// Puts how the job is as the reply's source, and as its topic what becomes of it from then on.
  void tell(WebReply& reply);

  /// Tells what has changed since it was last called, if anything has; for a clock of the network's
  /// thread. False where nobody reads any more.
  bool tick();

 private:
  class Snapshot;
  class AfterSnapshot;
  /// One who has been told everything up to `cursor`.
  struct Newcomer {
    std::weak_ptr<LiveReader> reader;
    ChangeCursor cursor;
  };
  void join(std::weak_ptr<LiveReader> reader, const ChangeCursor& cursor);
  grpc::Status step();
  grpc::Status tell_changes(ChangeCursor& cursor, const LiveReaders::Group* readers);
  void tell_gone(const std::string& message);

  Controller& controller_;
  Executors& executors_;
  const uint64_t job_;
  uint64_t watch_ = 0;
  std::shared_ptr<std::atomic<bool>> changed_ = std::make_shared<std::atomic<bool>>(true);
  std::atomic<bool> stepping_{false};
  core::Mutex mutex_;
  std::vector<Newcomer> newcomers_ HYADES_GUARDED_BY(mutex_);
  LiveReaders readers_ HYADES_GUARDED_BY(mutex_);  ///< who know

  // Of the thread that steps.
  ChangeCursor cursor_;  ///< up to which those who know have been told
  bool begun_ = false;   ///< cursor_ means something
};

}  // namespace hyades::coordinator
