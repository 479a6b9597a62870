#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <thread>

#include "core/base/mutex.h"
#include "core/base/result.h"

namespace hyades::coordinator {

/// An address that messages are posted to, one after the other, by a thread of its own: however
/// long the other side takes, nobody waits. Where the other side sends it elsewhere, it goes there
/// on the same scheme, host and port only: else whoever answers could have the coordinator post
/// to whatever it can reach.
class Hook {
 public:
  struct Options {
    std::string url;  ///< http:// or https://
    /// Whether its name may stand for an address of this machine or of a private network. A URL
    /// that says such an address itself, or localhost, may always.
    bool may_be_private = false;
    std::chrono::milliseconds first_wait{1000};  ///< after a failure; then twice as long each time
    std::chrono::milliseconds longest_wait{300'000};
    std::chrono::milliseconds give_up{std::chrono::hours(24)};  ///< on a message
    std::chrono::seconds timeout{20};                           ///< of one try
    /// Hears of messages that are given up, in one line.
    std::function<void(const std::string&)> tell = [](const std::string&) {};
  };
  explicit Hook(Options options);
  /// Tries what waits no more.
  ~Hook();
  Hook(const Hook&) = delete;
  Hook& operator=(const Hook&) = delete;

  /// Whether `url` is one that messages can be posted to; the error says what was expected.
  static core::Status check(const std::string& url);

  /// Has a JSON text posted. Where a thousand wait already, the oldest of them is given up.
  void post(std::string message);

 private:
  enum class Answer { taken, again, refused };
  void run();
  Answer try_once(const std::string& message, std::string& why) const;

  const Options options_;
  core::Mutex mutex_;
  core::CondVar wake_;
  std::deque<std::string> waiting_ HYADES_GUARDED_BY(mutex_);
  bool stop_ HYADES_GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

}  // namespace hyades::coordinator
