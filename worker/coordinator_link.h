#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <string>

#include "hyades/v1/work.pb.h"

namespace grpc {
class Channel;
}

namespace hyades::worker {

/// The stream to the coordinator, one at a time. Thread-safe.
class CoordinatorLink {
 public:
  /// Called from gRPC's threads; must not block and not call the link.
  class Owner {
   public:
    virtual ~Owner() = default;
    virtual void stream_says(v1::CoordinatorMessage message) = 0;
    /// The stream is over. `final`: coming again would end the same way (wrong token, version).
    /// Otherwise the coordinator asks not to come before `retry_after` has passed.
    virtual void stream_ended(bool final, const std::string& reason,
                              std::chrono::milliseconds retry_after) = 0;
  };

  CoordinatorLink(std::shared_ptr<grpc::Channel> channel, std::string token, Owner& owner);
  /// Breaks an open stream off and waits for its end.
  ~CoordinatorLink();
  CoordinatorLink(const CoordinatorLink&) = delete;
  CoordinatorLink& operator=(const CoordinatorLink&) = delete;

  /// Begins a stream; what is sent from now on waits until it is connected. Not while one is open.
  void open();

  /// Queues a message; nothing happens where no stream is open.
  void send(v1::WorkerMessage message);

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
