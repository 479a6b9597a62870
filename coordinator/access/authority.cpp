#include "coordinator/access/authority.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <openssl/crypto.h>

#include "coordinator/access/token.h"
#include "farm/json_form.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

constexpr std::string_view kBearer = "Bearer ";
/// Those that are of no use any more make room, the oldest first.
constexpr size_t kMostTokens = 10'000;
/// How far the stored time of a token's last use may be behind.
constexpr int64_t kUseStepMs = 60'000;
constexpr std::chrono::seconds kLongestSleep{30};
constexpr int64_t kDayMs = int64_t{24} * 3600 * 1000;
constexpr int64_t kTellAgainMs = kDayMs;
/// Who has not used his token for so long may not need it any more.
constexpr int64_t kStillUsedMs = 30 * kDayMs;

grpc::Status stranger(const std::string& why) { return {grpc::StatusCode::UNAUTHENTICATED, why}; }

/// In a time that does not depend on how much of it is right.
bool same(std::string_view a, std::string_view b) {
  return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

std::string date(int64_t ms) {
  return fmt::format("{:%Y-%m-%d %H:%M} UTC",
                     std::chrono::system_clock::time_point(std::chrono::milliseconds(ms)));
}

}  // namespace

Visit::~Visit() {
  const std::lock_guard lock(authority_.stays_mutex_);
  authority_.stays_.erase(number_);
}

Authority::Authority(JobStore& store, Options options)
    : store_(store), options_(std::move(options)) {}

core::Result<std::unique_ptr<Authority>> Authority::open(JobStore& store, Options options) {
  const auto rows = store.tokens();
  if (!rows) return rows.error();
  std::unique_ptr<Authority> authority(new Authority(store, std::move(options)));
  for (const StoredToken& row : *rows) authority->take_in(row);
  if (const std::string& folder = authority->options_.audit_folder; !folder.empty()) {
    auto log = AuditLog::open({.folder = folder});
    if (!log) return log.error();
    authority->audit_ = std::move(*log);
  }
  if (authority->options_.tell_unguarded) {
    authority->options_.tell_unguarded(authority->unguarded());
  }
  authority->thread_ = std::thread([&me = *authority] { me.mind(); });
  return authority;
}

Authority::~Authority() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
  store_uses();
}

void Authority::take_in(const StoredToken& row) { tokens_[row.id] = {row, row.used_ms, 0}; }

bool Authority::guarded() const {
  const std::lock_guard lock(mutex_);
  return !options_.shared_token.empty() || !tokens_.empty();
}

bool Authority::has_admin() const {
  const std::lock_guard lock(mutex_);
  if (!options_.shared_token.empty()) return true;
  const int64_t now = token_clock_ms();
  return std::any_of(tokens_.begin(), tokens_.end(), [&](const auto& token) {
    return token.second.row.role == v1::ROLE_ADMIN && is_live(token.second.row, now);
  });
}

std::string Authority::unguarded() const {
  if (!options_.beyond) return {};
  const bool tokens = guarded();
  if (!options_.plain && tokens) return {};
  if (!options_.plain) return "no token is asked for (--insecure): whoever reaches it may steer it";
  return tokens ? "plain text (--insecure): whoever listens may read everything, tokens too"
                : "plain text and no token (--insecure): whoever reaches it may read and steer it";
}

grpc::Status Authority::admit(std::string_view authorization, Caller& caller) {
  // Who has a token of another farm may come in as all others.
  if (!guarded()) return admit_known({}, caller);
  if (authorization.empty()) {
    return stranger(
        "this coordinator wants a token with every call: an admin makes one with 'hyades token "
        "create'");
  }
  const grpc::Status unknown = stranger("this is not a token of this coordinator");
  if (!authorization.starts_with(kBearer)) return unknown;
  const std::string_view shown = authorization.substr(kBearer.size());
  if (!options_.shared_token.empty() && same(shown, options_.shared_token)) {
    return admit_known(kSharedToken, caller);
  }
  const auto id = token_id(shown);
  if (!id) return unknown;
  const std::string hash = token_hash(shown);
  {
    const std::lock_guard lock(mutex_);
    const auto found = tokens_.find(*id);
    // Ids are no secret; a hash of 32 zeros is none of anything.
    const bool right = same(
        hash, found == tokens_.end() ? std::string(hash.size(), '\0') : found->second.row.hash);
    if (!right) return unknown;
  }
  return admit_known(*id, caller);
}

grpc::Status Authority::admit_known(const std::string& id, Caller& caller) {
  const int64_t now = token_clock_ms();
  const std::lock_guard lock(mutex_);
  if (const grpc::Status live = check(id, now); !live.ok()) return live;
  caller.token_id = id;
  const auto found = tokens_.find(id);
  if (found == tokens_.end()) {  // the shared one, or none is asked for
    caller.role = v1::ROLE_ADMIN;
    return grpc::Status::OK;
  }
  found->second.row.used_ms = now;
  caller.name = found->second.row.name;
  caller.role = static_cast<v1::Role>(found->second.row.role);
  caller.term = farm::term_of(found->second.row.created_ms, found->second.row.expires_ms);
  return grpc::Status::OK;
}

/// Whether this one may (still) come in; with the lock.
grpc::Status Authority::check(const std::string& id, int64_t now_ms) const {
  if (id.empty()) {
    const bool open = options_.shared_token.empty() && tokens_.empty();
    return open ? grpc::Status::OK : stranger("this coordinator asks for a token by now");
  }
  if (id == kSharedToken && !options_.shared_token.empty()) return grpc::Status::OK;
  const auto found = tokens_.find(id);
  if (found == tokens_.end()) return stranger("this is not a token of this coordinator");
  const StoredToken& row = found->second.row;
  if (row.revoked_ms != 0) {
    return stranger(fmt::format("the token {} of {} was revoked on {}: ask an admin for another",
                                row.id, row.name, date(row.revoked_ms)));
  }
  if (!is_live(row, now_ms)) {
    return stranger(fmt::format("the token {} of {} expired on {}: ask an admin for another",
                                row.id, row.name, date(row.expires_ms)));
  }
  return grpc::Status::OK;
}

std::unique_ptr<Visit> Authority::visit(const Caller& caller,
                                        std::function<void(const grpc::Status&)> leave) {
  const std::lock_guard staying(stays_mutex_);
  auto visit = std::make_unique<Visit>(*this, next_stay_);
  grpc::Status live;
  {
    const std::lock_guard lock(mutex_);
    live = check(caller.token_id, token_clock_ms());
  }
  if (live.ok()) {
    stays_[next_stay_] = {caller.token_id, caller.session, std::move(leave)};
  } else {
    leave(live);
  }
  ++next_stay_;
  return visit;
}

void Authority::end_session(const std::string& session) {
  const std::lock_guard staying(stays_mutex_);
  for (auto stay = stays_.begin(); stay != stays_.end();) {
    if (session.empty() || stay->second.session != session) {
      ++stay;
      continue;
    }
    stay->second.leave(stranger("the session was signed out"));
    stay = stays_.erase(stay);
  }
}

/// Those whose token is of no use any more have to go.
void Authority::end_stays() {
  const std::lock_guard staying(stays_mutex_);
  const int64_t now = token_clock_ms();
  for (auto stay = stays_.begin(); stay != stays_.end();) {
    grpc::Status live;
    {
      const std::lock_guard lock(mutex_);
      live = check(stay->second.token_id, now);
    }
    if (live.ok()) {
      ++stay;
      continue;
    }
    stay->second.leave(live);
    stay = stays_.erase(stay);
  }
}

grpc::Status Authority::create(const std::string& name, v1::Role role, int64_t lifetime_ms,
                               std::string& text, StoredToken& row) {
  const std::lock_guard one(change_mutex_);
  const int64_t now = token_clock_ms();
  auto fresh = make_token(name, role, lifetime_ms, now);
  if (!fresh) return {grpc::StatusCode::INVALID_ARGUMENT, fresh.error().message};
  const bool first = !guarded();
  if (first && role != v1::ROLE_ADMIN) {
    return {grpc::StatusCode::FAILED_PRECONDITION,
            "this farm has no tokens, and its first one shuts out all who have none: make one of "
            "an admin first (hyades token create --role admin --name NAME)"};
  }
  if (const core::Status room = make_room(now); !room) {
    return {grpc::StatusCode::RESOURCE_EXHAUSTED, room.error().message};
  }
  if (const core::Status stored = store_.add_token(fresh->row); !stored) {
    return farm::unavailable(stored.error());
  }
  {
    const std::lock_guard lock(mutex_);
    take_in(fresh->row);
  }
  wake_.notify_all();
  if (first) {
    end_stays();
    if (options_.tell_unguarded) options_.tell_unguarded(unguarded());
  }
  text = std::move(fresh->text);
  row = std::move(fresh->row);
  return grpc::Status::OK;
}

core::Status Authority::make_room(int64_t now_ms) {
  std::string oldest;
  {
    const std::lock_guard lock(mutex_);
    if (tokens_.size() < kMostTokens) return {};
    int64_t made = INT64_MAX;
    for (const auto& [id, token] : tokens_) {
      if (is_live(token.row, now_ms) || token.row.created_ms >= made) continue;
      oldest = id;
      made = token.row.created_ms;
    }
  }
  if (oldest.empty()) {
    return core::Error{fmt::format("there are {} tokens in use: revoke some", kMostTokens)};
  }
  if (core::Status gone = store_.forget_token(oldest); !gone) return gone;
  const std::lock_guard lock(mutex_);
  tokens_.erase(oldest);
  return {};
}

grpc::Status Authority::revoke(const std::string& id, StoredToken& row) {
  const std::lock_guard one(change_mutex_);
  {
    const std::lock_guard lock(mutex_);
    const auto found = tokens_.find(id);
    if (found == tokens_.end()) {
      return {grpc::StatusCode::NOT_FOUND,
              fmt::format("there is no token '{}': 'hyades token list' has their ids", id)};
    }
    if (found->second.row.revoked_ms == 0) found->second.row.revoked_ms = token_clock_ms();
    row = found->second.row;
  }
  end_stays();
  const core::Status stored = store_.revoke_token(id, row.revoked_ms);
  if (stored) return grpc::Status::OK;
  return {grpc::StatusCode::UNAVAILABLE,
          fmt::format("the token is revoked, but this could not be stored and ends with the "
                      "coordinator's next start: {}",
                      stored.error().message)};
}

std::vector<StoredToken> Authority::tokens() const {
  std::vector<StoredToken> all;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [id, token] : tokens_) all.push_back(token.row);
  }
  std::sort(all.begin(), all.end(), [](const StoredToken& a, const StoredToken& b) {
    return a.created_ms != b.created_ms ? a.created_ms < b.created_ms : a.id < b.id;
  });
  return all;
}

void Authority::store_uses() {
  std::vector<TokenUse> uses;
  {
    const std::lock_guard lock(mutex_);
    for (auto& [id, token] : tokens_) {
      if (token.row.used_ms < token.noted_ms + (stop_ ? 1 : kUseStepMs)) continue;
      token.noted_ms = token.row.used_ms;
      uses.push_back({id, token.row.used_ms});
    }
  }
  // Where the store refuses, a later use is stored.
  if (!uses.empty()) (void)store_.note_uses(uses);
}

/// One that nobody uses may expire in peace.
void Authority::tell_expiring() {
  if (!options_.tell_expiring) return;
  std::vector<std::string> lines;
  {
    const std::lock_guard lock(mutex_);
    const int64_t now = token_clock_ms();
    for (auto& [id, token] : tokens_) {
      const StoredToken& row = token.row;
      if (row.revoked_ms != 0 || row.used_ms == 0 || now - row.used_ms > kStillUsedMs ||
          now - token.told_ms < kTellAgainMs) {
        continue;
      }
      const std::string when =
          farm::expiry_warning(farm::term_of(row.created_ms, row.expires_ms), now);
      if (when.empty()) continue;
      token.told_ms = now;
      lines.push_back(fmt::format("the token {} of {} ({}) {}: 'hyades token create' makes another",
                                  id, row.name, farm::role_name(static_cast<v1::Role>(row.role)),
                                  when));
    }
  }
  for (const std::string& line : lines) options_.tell_expiring(line);
}

void Authority::mind() {
  tell_expiring();
  std::unique_lock lock(mutex_);
  while (!stop_) {
    const int64_t now = token_clock_ms();
    int64_t next = now + std::chrono::milliseconds(kLongestSleep).count();
    for (const auto& [id, token] : tokens_) {
      if (is_live(token.row, now) && token.row.expires_ms != 0) {
        next = std::min(next, token.row.expires_ms);
      }
    }
    wake_.wait_until(lock, std::chrono::system_clock::time_point(std::chrono::milliseconds(next)));
    lock.unlock();
    end_stays();
    store_uses();
    tell_expiring();
    lock.lock();
  }
}

}  // namespace hyades::coordinator
