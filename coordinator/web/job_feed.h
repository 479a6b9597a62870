#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "coordinator/controller/controller.h"
#include "coordinator/operations/executors.h"
#include "coordinator/web/exchange.h"
#include "coordinator/web/live_readers.h"
#include "core/base/mutex.h"
#include "farm/json_form.h"

namespace hyades::coordinator {

/// What happens to one job (openapi.yaml, /jobs/{job}/events).
class JobFeed final : public LiveTopic, public std::enable_shared_from_this<JobFeed> {
 public:
  /// `controller` and `executors` outlive it.
  JobFeed(Controller& controller, Executors& executors, uint64_t job)
      : controller_(controller), executors_(executors), job_(job) {}
  ~JobFeed() override;
  JobFeed(const JobFeed&) = delete;
  JobFeed& operator=(const JobFeed&) = delete;

  void join(std::weak_ptr<LiveReader> reader) override;

  /// Tells what has changed since it was last called, if anything has; for a clock of the network's
  /// thread. False where nobody reads any more.
  bool tick();

 private:
  /// What has changed up to `cursor`.
  struct Changes {
    farm::Json json{};  ///< the job and its frames that have changed
    ChangeCursor cursor{};
    bool ended = false;  ///< the job has, and nothing follows
  };
  void step();
  grpc::Status read(Changes& news);
  void tell_those_who_know(const Changes& changes);
  void tell_newcomers(const Changes& all);
  void tell_gone(const std::string& message);

  Controller& controller_;
  Executors& executors_;
  const uint64_t job_;
  uint64_t watch_ = 0;
  std::shared_ptr<std::atomic<bool>> changed_ = std::make_shared<std::atomic<bool>>(true);
  std::atomic<bool> stepping_{false};
  core::Mutex mutex_;
  LiveReaders readers_ HYADES_GUARDED_BY(mutex_);

  // Of the thread that steps.
  ChangeCursor cursor_;  ///< up to which those who know have been told
  bool begun_ = false;   ///< cursor_ means something
};

}  // namespace hyades::coordinator
