#include "coordinator/access/authority.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <openssl/crypto.h>

#include "coordinator/access/address.h"
#include "coordinator/access/token.h"
#include "core/base/random_id.h"
#include "core/base/wall_clock.h"
#include "farm/json_form.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

constexpr std::string_view kBearer = "Bearer ";
/// Tokens that are of no use any more make room for new ones, the oldest first.
constexpr size_t kMostTokens = 10'000;
/// How far the stored time of a token's last use may be behind.
constexpr int64_t kUseStepMs = 60'000;
constexpr std::chrono::seconds kLongestSleep{30};
constexpr int64_t kDayMs = int64_t{24} * 3600 * 1000;
constexpr int64_t kTellAgainMs = kDayMs;
/// A token that was not used for so long may not be needed any more.
constexpr int64_t kStillUsedMs = 30 * kDayMs;

/// Tokens that are none, of one neighbourhood: how many at once, and how many more each second.
constexpr double kWrongAtOnce = 20;
constexpr double kWrongPerSecond = 0.2;
constexpr size_t kMostNeighbourhoods = 1000;
constexpr std::chrono::minutes kForgiven{10};

grpc::Status stranger(const std::string& why) { return {grpc::StatusCode::UNAUTHENTICATED, why}; }

/// Whether they are equal, in a time that does not depend on how much of them is.
bool same(std::string_view a, std::string_view b) {
  return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

std::string date(int64_t ms) {
  return fmt::format("{:%Y-%m-%d %H:%M} UTC",
                     std::chrono::system_clock::time_point(std::chrono::milliseconds(ms)));
}

/// Whether the connection from `peer` is of the user who has started this process, or root's.
bool is_owners(const std::string& peer, const OwnEnd& own_end) {
  const std::string own = own_end ? own_end() : std::string();
  if (own.empty()) return false;
  const std::optional<uid_t> user = user_of_peer(peer, own);
  // Else it may have been another's, who has come from the same port since.
  return user && is_own_user(*user) && own_end() == own;
}

}  // namespace

Visit::~Visit() {
  const core::MutexLock lock(authority_.streams_mutex_);
  authority_.streams_.erase(number_);
}

Authority::Authority(JobStore& store, Options options)
    : store_(store), options_(std::move(options)) {}

core::Result<std::unique_ptr<Authority>> Authority::open(JobStore& store, Options options) {
  const auto rows = store.tokens();
  if (!rows) return rows.error();
  if (options.machine_key.empty()) {
    auto key = core::random_id();
    if (!key) return key.error();
    options.machine_key = std::move(*key);
  }
  std::unique_ptr<Authority> authority(new Authority(store, std::move(options)));
  {
    const core::MutexLock lock(authority->mutex_);
    for (const StoredToken& row : *rows) authority->take_in(row);
  }
  if (const std::string& folder = authority->options_.audit_folder; !folder.empty()) {
    auto log = AuditLog::open({.folder = folder});
    if (!log) return log.error();
    authority->audit_ = std::move(*log);
  }
  if (authority->options_.tell_unguarded) {
    authority->options_.tell_unguarded(authority->unguarded());
  }
  authority->thread_ = std::thread([&me = *authority] { me.watch_expiry(); });
  return authority;
}

Authority::~Authority() {
  {
    const core::MutexLock lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
  store_uses();
}

void Authority::take_in(const StoredToken& row) { tokens_[row.id] = {row, row.used_ms, 0}; }

bool Authority::guarded() const {
  const core::MutexLock lock(mutex_);
  return !options_.shared_token.empty() || !tokens_.empty();
}

bool Authority::has_admin() const {
  const core::MutexLock lock(mutex_);
  if (!options_.shared_token.empty()) return true;
  const int64_t now = core::wall_ms();
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

grpc::Status Authority::admit(std::string_view authorization, Caller& caller, const OwnEnd& own) {
  // Who has a token of another farm may come in as all others.
  if (!guarded()) return admit_without_token(caller, own);
  if (authorization.empty()) {
    return stranger(
        "this coordinator wants a token with every call: an admin makes one with 'hyades token "
        "create'");
  }
  if (!authorization.starts_with(kBearer)) return refuse_unknown(caller.address);
  const std::string_view shown = authorization.substr(kBearer.size());
  if (!options_.shared_token.empty() && same(shown, options_.shared_token)) {
    return admit_known(kSharedToken, caller);
  }
  if (auto machine = read_machine_token(options_.machine_key, shown)) {
    caller.worker = std::move(machine->worker);
    return admit_known(machine->id, caller);
  }
  const auto id = token_id(shown);
  if (!id) return refuse_unknown(caller.address);
  const std::string hash = token_hash(shown);
  bool right = false;
  {
    const core::MutexLock lock(mutex_);
    const auto found = tokens_.find(*id);
    // Ids are no secret; a hash of 32 zeros is none of anything.
    right = same(hash,
                 found == tokens_.end() ? std::string(hash.size(), '\0') : found->second.row.hash);
  }
  return right ? admit_known(*id, caller) : refuse_unknown(caller.address);
}

grpc::Status Authority::admit_without_token(Caller& caller, const OwnEnd& own) {
  if (options_.owner_only && !is_owners(caller.address, own)) {
    return stranger(
        "this coordinator has no tokens and serves the user who started it alone: ask him for a "
        "token ('hyades token create'), or to start it with --insecure");
  }
  return admit_known({}, caller);
}

grpc::Status Authority::refuse_unknown(const std::string& address) {
  const auto now = std::chrono::steady_clock::now();
  std::string whose = neighbourhood_of(address);
  const core::MutexLock lock(wrong_mutex_);
  if (wrong_.size() >= kMostNeighbourhoods && !wrong_.contains(whose)) {
    // Those whose tries are long over make room; else all others count as one.
    std::erase_if(wrong_, [&](const auto& one) { return now - one.second.asked() > kForgiven; });
    if (wrong_.size() >= kMostNeighbourhoods) whose = "others";
  }
  const auto [found, fresh] =
      wrong_.try_emplace(whose, farm::TokenBucket(kWrongAtOnce, kWrongPerSecond, now));
  if (!found->second.take(now)) {
    return farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED,
                             "too many tokens from this address were none of this coordinator's",
                             std::chrono::seconds(10));
  }
  return stranger("this is not a token of this coordinator");
}

grpc::Status Authority::admit_known(const std::string& id, Caller& caller) {
  const int64_t now = core::wall_ms();
  const core::MutexLock lock(mutex_);
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
  caller.pool = found->second.row.pool;
  caller.machines = found->second.row.machines;
  caller.term = farm::term_of(found->second.row.created_ms, found->second.row.expires_ms);
  return grpc::Status::OK;
}

grpc::Status Authority::admit_worker(const Caller& caller, const std::string& worker, bool keeps,
                                     WorkerCredential& credential) const {
  credential = {};
  if (!caller.worker.empty() && caller.worker != worker) {
    return {grpc::StatusCode::PERMISSION_DENIED, "this token is another worker's"};
  }
  credential.owner = caller.name.empty() ? caller.token_id : caller.name;
  // Whoever else may work here may do everything.
  if (caller.role != v1::ROLE_WORKER) return grpc::Status::OK;
  if (caller.worker.empty() && keeps) {
    credential.machine_token = machine_token(options_.machine_key, {caller.token_id, worker});
  }
  credential.joined_with = caller.token_id;
  credential.machines = caller.machines;
  const bool own = !caller.worker.empty() || !credential.machine_token.empty();
  credential.name = !caller.pool.empty() ? "pool " + caller.pool
                    : own                ? "machine " + caller.token_id + " " + worker
                                         : "token " + caller.token_id;
  if (caller.pool.empty() && own) credential.origin = "token " + caller.token_id;
  return grpc::Status::OK;
}

/// Whether this one may (still) come in.
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
  const core::MutexLock streams_lock(streams_mutex_);
  auto visit = std::make_unique<Visit>(*this, next_stream_);
  grpc::Status live;
  {
    const core::MutexLock lock(mutex_);
    live = check(caller.token_id, core::wall_ms());
  }
  if (live.ok()) {
    streams_[next_stream_] = {caller.token_id, caller.session, std::move(leave)};
  } else {
    leave(live);
  }
  ++next_stream_;
  return visit;
}

void Authority::end_session(const std::string& session) {
  const core::MutexLock streams_lock(streams_mutex_);
  for (auto stream = streams_.begin(); stream != streams_.end();) {
    if (session.empty() || stream->second.session != session) {
      ++stream;
      continue;
    }
    stream->second.leave(stranger("the session is over: it was signed out, or gave way to others"));
    stream = streams_.erase(stream);
  }
}

/// Ends the streams of those whose token is of no use any more.
void Authority::end_expired() {
  const core::MutexLock streams_lock(streams_mutex_);
  const int64_t now = core::wall_ms();
  for (auto stream = streams_.begin(); stream != streams_.end();) {
    grpc::Status live;
    {
      const core::MutexLock lock(mutex_);
      live = check(stream->second.token_id, now);
    }
    if (live.ok()) {
      ++stream;
      continue;
    }
    stream->second.leave(live);
    stream = streams_.erase(stream);
  }
}

grpc::Status Authority::create(const std::string& name, v1::Role role, int64_t lifetime_ms,
                               std::string& text, StoredToken& row) {
  v1::CreateTokenRequest asked;
  asked.set_name(name);
  asked.set_role(role);
  asked.set_lifetime_ms(lifetime_ms);
  return create(asked, text, row);
}

grpc::Status Authority::create(const v1::CreateTokenRequest& asked, std::string& text,
                               StoredToken& row) {
  const core::MutexLock one(change_mutex_);
  const int64_t now = core::wall_ms();
  auto fresh = make_token(asked, now);
  if (!fresh) return {grpc::StatusCode::INVALID_ARGUMENT, fresh.error().message};
  const bool first = !guarded();
  if (first && asked.role() != v1::ROLE_ADMIN) {
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
    const core::MutexLock lock(mutex_);
    take_in(fresh->row);
  }
  wake_.notify_all();
  if (first) {
    end_expired();
    if (options_.tell_unguarded) options_.tell_unguarded(unguarded());
  }
  text = std::move(fresh->text);
  row = std::move(fresh->row);
  return grpc::Status::OK;
}

core::Status Authority::make_room(int64_t now_ms) {
  std::string oldest;
  {
    const core::MutexLock lock(mutex_);
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
  const core::MutexLock lock(mutex_);
  tokens_.erase(oldest);
  return {};
}

grpc::Status Authority::revoke(const std::string& id, StoredToken& row) {
  const core::MutexLock one(change_mutex_);
  {
    const core::MutexLock lock(mutex_);
    const auto found = tokens_.find(id);
    if (found == tokens_.end()) {
      return {grpc::StatusCode::NOT_FOUND,
              fmt::format("there is no token '{}': 'hyades token list' has their ids", id)};
    }
    if (found->second.row.revoked_ms == 0) found->second.row.revoked_ms = core::wall_ms();
    row = found->second.row;
  }
  end_expired();
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
    const core::MutexLock lock(mutex_);
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
    const core::MutexLock lock(mutex_);
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
    const core::MutexLock lock(mutex_);
    const int64_t now = core::wall_ms();
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

/// Until the end: ends streams of tokens that expire, and stores when tokens were used.
void Authority::watch_expiry() {
  tell_expiring();
  core::MutexLock lock(mutex_);
  while (!stop_) {
    const int64_t now = core::wall_ms();
    int64_t next = now + std::chrono::milliseconds(kLongestSleep).count();
    for (const auto& [id, token] : tokens_) {
      if (is_live(token.row, now) && token.row.expires_ms != 0) {
        next = std::min(next, token.row.expires_ms);
      }
    }
    wake_.wait_until(mutex_,
                     std::chrono::system_clock::time_point(std::chrono::milliseconds(next)));
    lock.unlock();
    end_expired();
    store_uses();
    tell_expiring();
    lock.lock();
  }
}

}  // namespace hyades::coordinator
