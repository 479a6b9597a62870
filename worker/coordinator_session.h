#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "farm/backoff.h"
#include "farm/channels.h"
#include "farm/token_term.h"
#include "worker/coordinator_link.h"
#include "worker/worker_context.h"
#include "worker/worker_identity.h"
#include "worker/worker_token.h"

namespace hyades::worker {

/// The streams to the coordinator, one after the other: when the next one begins, under which id
/// and with which token, and what is told of all that. For the loop's thread.
class CoordinatorSession : private CoordinatorLink::Listener {
 public:
  /// `new_token` is told of a token that comes in place of the first.
  CoordinatorSession(const WorkerContext& worker, WorkerIdentity id,
                     std::shared_ptr<farm::Channels> channels, WorkerToken token,
                     std::function<void(const std::string&)> new_token);

  /// Opens a stream where it is time for one: the first when the rendering child is `ready`.
  void tick(TimePoint now, bool ready);

  /// Ends the stream that is open; another one begins as after any that ends.
  void break_off(const std::string& reason);

  /// Queued on the stream that is open.
  void send(v1::WorkerMessage message) { link_.send(std::move(message)); }
  /// Whether everything that was sent has left this process.
  bool flowing() const { return link_.flowing(); }

  /// Nothing more will be sent.
  void finish();
  /// Whether a stream is open, or is being opened.
  bool open() const { return streaming_; }

 private:
  void connect(TimePoint now);
  void stream_says(v1::CoordinatorMessage message) override;
  void hear(v1::CoordinatorMessage message);
  void stream_ended(StreamEnd end, const std::string& reason,
                    std::chrono::milliseconds retry_after) override;
  bool welcomed(const v1::Welcome& welcome);
  void ended(StreamEnd end, const std::string& reason, std::chrono::milliseconds retry_after);
  void renew_id();
  void keep_token(const std::string& own);
  bool take_new_token();
  void show_token();
  bool may_hope();
  void tell_expiry(TimePoint now);
  void expect_welcome(TimePoint now);
  bool has_another_address(StreamEnd end);

  const WorkerContext worker_;
  WorkerIdentity id_;
  WorkerToken token_;
  const std::function<void(const std::string&)> new_token_;
  const std::shared_ptr<farm::Channels> channels_;
  farm::Channels::Way way_;  ///< of the last stream
  TimePoint opened_;         ///< when that began
  Duration welcome_patience_;
  farm::Backoff backoff_{farm::kFirstReconnect, farm::kLongestReconnect};
  bool streaming_ = false;
  bool broken_off_ = false;            ///< what still comes on this stream is not heard
  bool unwelcome_ = false;             ///< ... as nothing answered in time
  std::optional<TimePoint> welcomed_;  ///< when, on this stream
  bool ever_connected_ = false;
  bool ever_welcomed_ = false;
  bool finished_ = false;
  std::optional<TimePoint> connect_at_;
  std::optional<TimePoint> unknown_since_;  ///< the coordinator does not know the token any more
  std::string told_trouble_;
  std::string tls_trouble_;  ///< of an address, in this round
  farm::TokenTerm token_term_;
  std::optional<TimePoint> told_expiry_;
  CoordinatorLink link_;  ///< last: its threads post
};

}  // namespace hyades::worker
