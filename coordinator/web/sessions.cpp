#include "coordinator/web/sessions.h"

#include <algorithm>
#include <cstddef>

#include "core/base/hash.h"
#include "core/base/random_id.h"

namespace hyades::coordinator {
namespace {

constexpr size_t kMostSessions = 10'000;
/// Of one token: a person has some few browsers, and several may share one.
constexpr size_t kMostOfToken = 100;
constexpr size_t kSecretLength = 64;

/// What is compared is a hash, so that the time it takes tells nothing of the secret.
std::string key_of(std::string_view secret) {
  return core::to_hex(core::sha256("hyades session " + std::string(secret)));
}

}  // namespace

std::optional<Sessions::Opened> Sessions::open(const std::string& token_id, int64_t until) {
  const auto half = core::random_id();
  const auto rest = core::random_id();
  if (!half || !rest) return std::nullopt;
  Opened opened{*half + *rest, {}};
  const core::MutexLock lock(mutex_);
  size_t of_token = 0;
  auto oldest = open_.end();
  auto own = open_.end();  // the oldest of the token's
  for (auto one = open_.begin(); one != open_.end(); ++one) {
    if (oldest == open_.end() || one->second.number < oldest->second.number) oldest = one;
    if (one->second.token_id != token_id) continue;
    ++of_token;
    if (own == open_.end() || one->second.number < own->second.number) own = one;
  }
  const auto goes = of_token >= kMostOfToken        ? own
                    : open_.size() >= kMostSessions ? oldest
                                                    : open_.end();
  if (goes != open_.end()) {
    opened.ended = goes->first;
    open_.erase(goes);
  }
  open_[key_of(opened.secret)] = {token_id, until, next_++};
  return opened;
}

std::optional<Sessions::Session> Sessions::find(std::string_view secret, int64_t now) const {
  if (secret.size() != kSecretLength) return std::nullopt;
  const core::MutexLock lock(mutex_);
  const auto found = open_.find(key_of(secret));
  if (found == open_.end() || now >= found->second.until) return std::nullopt;
  return Session{found->first, found->second.token_id};
}

std::optional<Sessions::Session> Sessions::end(std::string_view secret) {
  if (secret.size() != kSecretLength) return std::nullopt;
  const core::MutexLock lock(mutex_);
  const auto found = open_.find(key_of(secret));
  if (found == open_.end()) return std::nullopt;
  Session ended{found->first, found->second.token_id};
  open_.erase(found);
  return ended;
}

}  // namespace hyades::coordinator
