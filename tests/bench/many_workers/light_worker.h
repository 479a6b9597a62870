#pragma once

#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>

#include <atomic>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "core/film/layout.h"
#include "hyades/v1/work.grpc.pb.h"
#include "tests/bench/many_workers/latencies.h"
#include "tests/bench/many_workers/timer.h"

namespace hyades::bench {

/// What all light-weight workers share.
struct Crowd {
  Timer& timer;
  Timer& beats;  ///< for heartbeats alone: they are not late because films are being made
  core::FilmLayout layout;
  uint32_t samples = 0;           ///< per pixel, of the job
  double seconds_per_sample = 0;  ///< what they pretend that a sample takes
  Latencies lease{};              ///< from a wish to its lease
  Latencies acknowledgement{};    ///< from a film sent to its acknowledgement
  std::atomic<uint64_t> welcomed{0}, units{0}, acknowledged{0}, rejected{0}, ended{0};
};

/// A worker of one thread without light over a connection of its own: wishes for a unit, waits as
/// long as rendering it would take, delivers a film of noise together with the next wish. It costs
/// no thread.
class LightWorker : public grpc::ClientBidiReactor<v1::WorkerMessage, v1::CoordinatorMessage> {
 public:
  LightWorker(Crowd& crowd, std::shared_ptr<grpc::Channel> channel, const std::string& token,
              int number);

  /// Breaks the connection; OnDone() follows.
  void leave() { context_.TryCancel(); }
  bool done() const { return done_; }
  std::string trouble() const {
    const std::lock_guard lock(mutex_);
    return trouble_;
  }

  void OnReadDone(bool ok) override;
  void OnWriteDone(bool ok) override;
  void OnDone(const grpc::Status& status) override;

 private:
  using Clock = Timer::Clock;

  void send(v1::WorkerMessage message);
  void write_next();
  void beat();
  void finish(const v1::LeasedUnit& leased, double seconds);
  void on_lease(const v1::Lease& lease);

  Crowd& crowd_;
  std::unique_ptr<v1::Work::Stub> stub_;
  grpc::ClientContext context_;
  v1::CoordinatorMessage incoming_;
  std::atomic<bool> done_{false};

  mutable std::mutex mutex_;
  std::deque<v1::WorkerMessage> outgoing_;
  bool writing_ = false;
  std::map<std::string, v1::LeaseId> in_hand_;
  std::map<std::string, Clock::time_point> delivered_;
  Clock::time_point wished_;
  uint64_t beats_ = 0;
  std::chrono::milliseconds beat_every_{0};
  std::string trouble_;
};

}  // namespace hyades::bench
