#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "hyades/v1/work.pb.h"

namespace grpc {
class Channel;
}

namespace hyades::worker {

/// What the end of a stream means for the next one.
enum class StreamEnd : uint8_t {
  broken,      ///< another one is worth a try
  unanswered,  ///< nothing answered, or does no more: another address may
  unknown,     ///< the coordinator does not know the token
  refused,     ///< another one would end the same way (a token of another role, version)
  id_taken     ///< another process works under this worker's id: it needs a new one
};

/// The stream to the coordinator, one at a time. Thread-safe.
class CoordinatorLink {
 public:
  /// Called from gRPC's threads; must not block and not call the link.
  class Listener {
   public:
    virtual ~Listener() = default;
    /// To be answered by heard(), when nothing is left of it but what the listener keeps.
    virtual void stream_says(v1::CoordinatorMessage message) = 0;
    /// The stream is over. Where another one is worth it the coordinator asks not to come before
    /// `retry_after` has passed.
    virtual void stream_ended(StreamEnd end, const std::string& reason,
                              std::chrono::milliseconds retry_after) = 0;
  };

  CoordinatorLink(std::string token, Listener& listener);
  /// Breaks an open stream off and waits for its end.
  ~CoordinatorLink();
  CoordinatorLink(const CoordinatorLink&) = delete;
  CoordinatorLink& operator=(const CoordinatorLink&) = delete;

  /// Of streams that begin from now on.
  void set_token(std::string token);

  /// Begins a stream; what is sent from now on waits until it is connected. Not while one is open.
  /// `channel` outlives the link: gRPC's own threads cannot end it.
  void open(const std::shared_ptr<grpc::Channel>& channel);

  /// Queues a message; nothing happens where no stream is open.
  void send(v1::WorkerMessage message);

  /// The listener is done with a message. While it has too many of them, or too much is queued, no
  /// more are read: a coordinator that talks without end takes no memory here.
  void heard();

  /// Messages, and bytes of these, that the listener has before it at once (the last may be
  /// larger).
  static constexpr size_t kMostUnheard = 64;
  static constexpr size_t kMostUnheardBytes = size_t{1} << 20U;
  /// Messages to the coordinator, and bytes of these, that wait to be sent: beyond them nothing
  /// more is read, for it could ask for further ones.
  static constexpr size_t kMostQueued = 10'000;
  static constexpr size_t kMostQueuedBytes = size_t{256} << 20U;

  /// Ends the stream that is open at once; the listener hears of it, with this reason.
  void break_off(const std::string& reason);

  /// Whether everything that was sent has left this process.
  bool flowing() const;

  /// Nothing more will be sent: ends the stream in good order after what is queued.
  void finish();

  struct State;

 private:
  class Stream;
  std::shared_ptr<State> state_;
};

}  // namespace hyades::worker
