#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>

#include "coordinator/controller/controller.h"
#include "coordinator/operations/executors.h"
#include "coordinator/web/exchange.h"
#include "coordinator/web/live_readers.h"

namespace hyades::coordinator {

/// What happens to one job (openapi.yaml, /jobs/{job}/events).
class JobFeed final : public LiveTopic, public std::enable_shared_from_this<JobFeed> {
 public:
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
  void step();
  grpc::Status changes(ChangeCursor& cursor, farm::Json& change, bool& ended);

  Controller& controller_;
  Executors& executors_;
  const uint64_t job_;
  uint64_t watch_ = 0;
  std::shared_ptr<std::atomic<bool>> changed_ = std::make_shared<std::atomic<bool>>(true);
  std::atomic<bool> stepping_{false};
  std::mutex mutex_;  ///< guards readers_
  LiveReaders readers_;
  ChangeCursor cursor_;  ///< to those who know; of the thread that steps
  bool begun_ = false;   ///< cursor_ means something
};

}  // namespace hyades::coordinator
