#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/controller/controller.h"
#include "coordinator/operations/executors.h"
#include "coordinator/web/exchange.h"
#include "coordinator/web/live_readers.h"
#include "coordinator/web/live_rows.h"
#include "core/base/mutex.h"
#include "farm/json_form.h"

namespace hyades::coordinator {

/// What happens on the farm (openapi.yaml, /events).
class FarmFeed final : public LiveTopic, public std::enable_shared_from_this<FarmFeed> {
 public:
  /// `controller` and `executors` outlive it.
  FarmFeed(Controller& controller, Executors& executors);

  void join(std::weak_ptr<LiveReader> reader) override;
  /// Tells what has changed since it was last called; to be called once a second.
  void tick();

 private:
  void step();
  void note_throughput(const std::vector<v1::Worker>& workers);
  farm::Json changes(const std::vector<v1::Worker>& workers);
  farm::Json tell_jobs(LiveRows::Rows& jobs);
  void cut_off_slow_readers();

  Controller& controller_;
  Executors& executors_;
  std::atomic<bool> stepping_{false};
  core::Mutex mutex_;
  LiveReaders readers_ HYADES_GUARDED_BY(mutex_);

  // Of the thread that steps.
  /// A snapshot that may not have been read yet, and by whom.
  struct Unread {
    std::weak_ptr<const std::string> snapshot;
    LiveReaders::Group readers;
  };
  std::vector<Unread> snapshots_;
  farm::Json info_;
  LiveRows jobs_;
  LiveRows workers_;
  std::map<uint64_t, uint64_t> samples_;  ///< that workers had done
  uint64_t new_samples_ = 0;              ///< since the last value of the row
  std::chrono::steady_clock::time_point value_since_;
  std::deque<double> throughput_;    ///< samples per second, of the last hour
  std::optional<double> new_value_;  ///< of throughput_, which nobody was told of yet
};

}  // namespace hyades::coordinator
