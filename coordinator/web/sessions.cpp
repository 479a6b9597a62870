#include "coordinator/web/sessions.h"

#include <algorithm>
#include <cstddef>

#include "core/base/hash.h"
#include "core/base/random_id.h"

namespace hyades::coordinator {
namespace {

constexpr size_t kMostSessions = 10'000;
constexpr size_t kSecretLength = 64;

/// What is compared is a hash, so that the time it takes tells nothing of the secret.
std::string key_of(std::string_view secret) {
  return core::to_hex(core::sha256("hyades session " + std::string(secret)));
}

}  // namespace

std::optional<std::string> Sessions::open(const std::string& token_id, int64_t until) {
  const auto half = core::random_id();
  const auto rest = core::random_id();
  if (!half || !rest) return std::nullopt;
  const std::string secret = *half + *rest;
  const core::MutexLock lock(mutex_);
  if (open_.size() >= kMostSessions) {
    open_.erase(std::min_element(open_.begin(), open_.end(), [](const auto& a, const auto& b) {
      return a.second.until < b.second.until;
    }));
  }
  open_[key_of(secret)] = {token_id, until};
  return secret;
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
