#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace hyades::coordinator {

/// Neighbourhoods of which somebody has shown a token lately, and which token that was. Of each
/// token the last thousands of them are kept at least, and those of a day. So who shows one token
/// from everywhere pushes out nobody else's. Knows no clock. Not thread-safe.
class TrustedNeighbours {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Each is trusted for `time` at least, unless more than `most` have come since with its token.
  explicit TrustedNeighbours(std::chrono::hours time = std::chrono::hours(24), size_t most = 4096)
      : time_(time), most_(most) {}

  /// Somebody of there has shown the token of this id (Caller::token_id).
  void trust(const std::string& neighbourhood, const std::string& token_id, Time now);
  /// The tokens that were shown from there, but four at most: the last, and those of fewest
  /// neighbourhoods. Those that somebody shows from an address that he shares with others take
  /// nothing from theirs. Good until trust() is called.
  const std::vector<std::string>& tokens_of(const std::string& neighbourhood) const;

 private:
  /// In two generations, so that what is too old needs not be looked for one by one.
  struct OfToken {
    std::set<std::string> now;     ///< since `since`
    std::set<std::string> before;  ///< of the time before
    Time since{};
  };

  void forget(const std::string& neighbourhood, const std::string& token_id);

  std::chrono::hours time_;
  size_t most_;
  std::map<std::string, OfToken> tokens_;
  std::map<std::string, std::vector<std::string>> tokens_of_;
};

}  // namespace hyades::coordinator
