#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/mutex.h"

namespace hyades::coordinator {

/// The sessions of browsers: a random name for each token that was shown. They are in memory alone,
/// so they end with the process. Thread-safe.
class Sessions {
 public:
  struct Session {
    std::string key;       ///< tells it from others, and is no secret: a hash of its secret name
    std::string token_id;  ///< of the token that has opened it
  };

  /// A session that has just been opened.
  struct Opened {
    std::string secret;  ///< its secret name: 64 hexadecimal digits
    std::string ended;   ///< the key of the one that had to go; empty: none
  };
  /// Opens a session for a token, until `until` (seconds since 1970); nothing where the system
  /// gives no random numbers. Where the token has 100, or all together 10,000, the oldest of them
  /// goes.
  std::optional<Opened> open(const std::string& token_id, int64_t until);

  /// The session of this secret name; nothing where it is not open at `now` (seconds since 1970).
  std::optional<Session> find(std::string_view secret, int64_t now) const;

  /// Ends the session of this secret name: what it was; nothing where there is none.
  std::optional<Session> end(std::string_view secret);

 private:
  struct Open {
    std::string token_id;
    int64_t until = 0;
    uint64_t number = 0;  ///< in the order in which they were opened
  };
  mutable core::Mutex mutex_;
  std::map<std::string, Open> open_ HYADES_GUARDED_BY(mutex_);  ///< by key
  uint64_t next_ HYADES_GUARDED_BY(mutex_) = 0;
};

}  // namespace hyades::coordinator
