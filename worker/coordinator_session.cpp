#include "worker/coordinator_session.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "core/base/text.h"
#include "core/base/wall_clock.h"
#include "farm/wire.h"

namespace hyades::worker {
namespace {

using Clock = std::chrono::steady_clock;
using farm::LogLevel;
using std::chrono::milliseconds;

/// How long a worker whose token is unknown all at once looks for another in its file.
constexpr std::chrono::minutes kTokenPatience{5};
constexpr std::chrono::hours kTellExpiryAgain{24};
/// Bytes of this worker's name (docs/wire.md).
constexpr size_t kLongestName = 200;
/// A stream that lasted for so long was a good one: the first pause after it is short again.
constexpr std::chrono::seconds kGoodStream{10};
/// However long a coordinator asks not to be called.
constexpr milliseconds kLongestAskedPause{60'000};
/// What the first message of a stream may take where another address may answer instead; twice as
/// much with each round in which none does, as one that answers may be slow.
constexpr std::chrono::seconds kFirstWelcome{3};
constexpr std::chrono::seconds kLongestWelcome{30};

}  // namespace

CoordinatorSession::CoordinatorSession(const WorkerContext& worker, WorkerIdentity id,
                                       std::shared_ptr<farm::Channels> channels, WorkerToken token,
                                       std::function<void(const std::string&)> new_token)
    : worker_(worker),
      id_(std::move(id)),
      token_(std::move(token)),
      new_token_(std::move(new_token)),
      channels_(std::move(channels)),
      welcome_patience_(kFirstWelcome),
      link_(token_.text(), *this) {}

void CoordinatorSession::tick(TimePoint now, bool ready) {
  if (ever_connected_ ? connect_at_ && now >= *connect_at_ : ready) connect(now);
  expect_welcome(now);
  tell_expiry(now);
}

void CoordinatorSession::connect(TimePoint now) {
  connect_at_.reset();
  ever_connected_ = true;
  streaming_ = true;
  broken_off_ = false;
  unwelcome_ = false;
  welcomed_.reset();
  way_ = channels_->current();
  opened_ = now;
  link_.open(way_.channel);
  worker_.machine.stream_opened(now);
}

/// A coordinator that is frozen takes the connection, and is silent.
void CoordinatorSession::expect_welcome(TimePoint now) {
  if (channels_->size() == 1 || !streaming_ || broken_off_ || welcomed_) return;
  if (now - opened_ < welcome_patience_) return;
  unwelcome_ = true;
  break_off("it does not answer");
}

void CoordinatorSession::finish() {
  finished_ = true;
  link_.finish();
}

void CoordinatorSession::stream_says(v1::CoordinatorMessage message) {
  worker_.loop.post([this, message = std::move(message)]() mutable {
    hear(std::move(message));
    link_.heard();
  });
}

void CoordinatorSession::hear(v1::CoordinatorMessage message) {
  if (broken_off_) return;
  const TimePoint now = Clock::now();
  if (message.has_welcome() && !std::exchange(welcomed_, now) && !welcomed(message.welcome()))
    return;
  worker_.machine.coordinator_says(std::move(message), now);
}

void CoordinatorSession::break_off(const std::string& reason) {
  broken_off_ = true;
  link_.break_off(reason);
}

/// Whether the two understand each other.
bool CoordinatorSession::welcomed(const v1::Welcome& welcome) {
  if (welcome.protocol() < farm::kOldestProtocol) {
    worker_.log.note(
        LogLevel::error,
        fmt::format("the coordinator speaks protocol {}, this worker {} to {}: update it",
                    welcome.protocol(), farm::kOldestProtocol, farm::kProtocol));
    worker_.loop.end(2);
    return false;
  }
  told_trouble_.clear();
  tls_trouble_.clear();
  welcome_patience_ = kFirstWelcome;
  ever_welcomed_ = true;
  unknown_since_.reset();
  const std::string name = farm::wire_text(welcome.name()).substr(0, kLongestName);
  worker_.log.rename(name);
  if (!welcome.machine_token().empty()) keep_token(welcome.machine_token());
  token_term_ = {welcome.token_expires_ms(), welcome.token_warn_ms()};
  worker_.log.note(LogLevel::info, fmt::format("working for {} as {}", way_.address, name));
  return true;
}

void CoordinatorSession::stream_ended(StreamEnd end, const std::string& reason,
                                      milliseconds retry_after) {
  worker_.loop.post([this, end, reason, retry_after] { ended(end, reason, retry_after); });
}

void CoordinatorSession::ended(StreamEnd end, const std::string& reason, milliseconds retry_after) {
  streaming_ = false;
  worker_.machine.stream_closed();
  if (worker_.loop.ended()) return;
  if (end == StreamEnd::unknown && take_new_token()) {
    connect_at_ = Clock::now();
    return;
  }
  if (end == StreamEnd::refused || (end == StreamEnd::unknown && !may_hope())) {
    worker_.log.note(LogLevel::error, "the coordinator refuses this worker: " + reason);
    worker_.loop.end(2);
    return;
  }
  if (end == StreamEnd::id_taken) renew_id();
  // Who welcomes and hangs up at once is not called all the time.
  if (welcomed_ && Clock::now() - *welcomed_ >= kGoodStream) {
    backoff_.reset();
    channels_->answered();
  }
  const bool another = has_another_address(end);
  connect_at_ = Clock::now();
  if (!another) *connect_at_ += backoff_.next(std::min<Duration>(retry_after, kLongestAskedPause));
  std::string trouble = farm::connection_trouble(reason, worker_.options.coordinator);
  const auto tls = farm::tls_trouble(reason, worker_.options.coordinator);
  if (another && tls) tls_trouble_ = way_.address + ": " + *tls;
  // Of a round in which no address answers one thing is told: that a coordinator stands by, and is
  // silent, says less than what is amiss with TLS.
  if (!another && !tls_trouble_.empty()) trouble = std::exchange(tls_trouble_, {});
  if (finished_ || (another && !welcomed_) || trouble == told_trouble_) return;
  worker_.log.note(
      LogLevel::warning,
      fmt::format("no connection to {} ({}); {} in hand, {} not acknowledged; trying again",
                  worker_.options.coordinator.address, trouble,
                  core::counted(worker_.machine.in_hand(), "unit"),
                  core::counted(worker_.machine.unacknowledged(), "film")));
  told_trouble_ = std::move(trouble);
}

/// Whether the stream ended for lack of an answer, and the next address is worth a try at once.
bool CoordinatorSession::has_another_address(StreamEnd end) {
  if (end != StreamEnd::unanswered && !unwelcome_) return false;
  const bool another = channels_->failed(way_);
  if (!another) welcome_patience_ = std::min<Duration>(2 * welcome_patience_, kLongestWelcome);
  return another;
}

/// There are two with one id, and the other was first.
void CoordinatorSession::renew_id() {
  if (auto renewed = id_.renew(); !renewed) {
    worker_.log.note(LogLevel::error, renewed.error().message);
    worker_.loop.end(1);
    return;
  }
  worker_.machine.rename(id_.text());
  if (auto joins = token_.read(id_.text()); !joins) {
    worker_.log.note(LogLevel::error, "this worker cannot join anew: " + joins.error().message);
    worker_.loop.end(2);
    return;
  }
  show_token();
  worker_.log.note(
      LogLevel::warning,
      "another worker has this one's id (a copied cache, or machine): it takes a new one");
}

/// The worker's own token from its next stream on. Where it cannot be kept the one that it has
/// joined with goes on to do.
void CoordinatorSession::keep_token(const std::string& own) {
  if (auto kept = token_.keep(own, id_.text()); !kept) {
    worker_.log.note(LogLevel::warning,
                     "the token of this worker's own cannot be kept: " + kept.error().message);
    return;
  }
  show_token();
}

/// Whether there is another token than was shown: tokens are changed under workers that run.
bool CoordinatorSession::take_new_token() {
  const bool another = token_.replace(id_.text());
  show_token();
  if (!another) return false;
  worker_.log.note(LogLevel::info, "shows the coordinator the token that " +
                                       worker_.options.coordinator.token_file + " holds now");
  return true;
}

/// With all that begins from now on.
void CoordinatorSession::show_token() {
  link_.set_token(token_.text());
  new_token_(token_.text());
}

/// Who was known once waits for their new token a while, with the films in their hand.
bool CoordinatorSession::may_hope() {
  if (!ever_welcomed_) return false;
  if (!unknown_since_) unknown_since_ = Clock::now();
  return Clock::now() - *unknown_since_ < kTokenPatience;
}

/// Once a day, in the token's last days.
void CoordinatorSession::tell_expiry(TimePoint now) {
  if (told_expiry_ && now - *told_expiry_ < kTellExpiryAgain) return;
  const std::string when = farm::expiry_warning(token_term_, core::wall_ms());
  if (when.empty()) return;
  told_expiry_ = now;
  worker_.log.note(LogLevel::warning, "the token of this worker " + when +
                                          ": put another one into " +
                                          worker_.options.coordinator.token_file);
}

}  // namespace hyades::worker
