#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "coordinator/notify/hook.h"
#include "coordinator/notify/news.h"
#include "farm/retry_queue.h"

namespace hyades::coordinator {

class Controller;

/// Watches all jobs and posts what people want to hear of: that one is done, has failed, or stands
/// still. It only asks the controller, so that nothing of the farm ever waits for it. Jobs that end
/// while the coordinator ends are not told of.
class Notifier {
 public:
  struct Options {
    std::vector<std::string> hooks;            ///< URLs that take program_message()
    std::vector<std::string> chats;            ///< URLs that take chat_message()
    std::string dashboard;                     ///< its URL as people reach it; empty: none is told
    std::chrono::milliseconds stall{600'000};  ///< without a new sample of a running job
    std::chrono::milliseconds look{1000};      ///< how often it looks at the jobs
    Hook::Options hook{};                      ///< of all hooks and chats, but for the URL
  };
  /// `controller` outlives the notifier.
  Notifier(Controller& controller, Options options);

 private:
  using Clock = std::chrono::steady_clock;
  /// An open job as it was seen last.
  struct Seen {
    uint64_t samples_done = 0;
    Clock::time_point since;
    bool told = false;  ///< that it stands still
  };

  void look();
  void look_at(const v1::Job& job, Clock::time_point now);
  void tell_of_end(const v1::Job& job);
  void tell_of_unseen();
  void tell(const News& news);

  Controller& controller_;
  const Options options_;
  std::vector<std::unique_ptr<Hook>> hooks_;
  std::vector<std::unique_ptr<Hook>> chats_;
  std::map<uint64_t, Seen> open_;
  uint64_t newest_ = 0;  ///< all jobs up to this one have been seen
  farm::RetryQueue looks_;
};

}  // namespace hyades::coordinator
