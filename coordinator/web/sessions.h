#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

namespace hyades::coordinator {

/// Who has signed in with a browser: random names for tokens that were shown, in memory alone, so
/// that they end with the process. Thread-safe.
class Sessions {
 public:
  struct Session {
    std::string key;       ///< names it among us, and is no secret: a hash of what the browser has
    std::string token_id;  ///< that has opened it
  };

  /// A new one for the token, until `until` (seconds since 1970): its secret name, 64 hexadecimal
  /// digits; nothing where the system gives no random numbers. Of more than 10,000 those that end
  /// first go.
  std::optional<std::string> open(const std::string& token_id, int64_t until);

  /// Which one this is, if it is open at `now`.
  std::optional<Session> find(std::string_view secret, int64_t now) const;

  /// It is of no use from now on; which one it was, if it was one.
  std::optional<Session> end(std::string_view secret);

 private:
  struct Open {
    std::string token_id;
    int64_t until = 0;
  };
  mutable std::mutex mutex_;
  std::map<std::string, Open> open_;  ///< by key
};

}  // namespace hyades::coordinator
