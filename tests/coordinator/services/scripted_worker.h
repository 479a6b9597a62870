#pragma once

#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/base/random_id.h"
#include "core/film/film.h"
#include "core/film/film_codec.h"
#include "farm/backoff.h"
#include "farm/channel.h"
#include "farm/wire.h"
#include "hyades/v1/work.grpc.pb.h"
#include "tests/coordinator/services/fake_films.h"

namespace hyades::coordinator {

/// A worker without light over real gRPC: takes leases, renders fake films, delivers them, keeps
/// what is not acknowledged over reconnects. Its thread ends with the object.
class ScriptedWorker {
 public:
  struct Script {
    std::string id = "scripted-worker-0001";
    std::string instance;  ///< of its process; one of its own without
    std::string name = "scripted/1";
    std::string worker_class = "class-a";
    std::string portable_class;
    std::string token;
    bool keeps_token = false;  ///< takes one of its machine's own
    uint32_t threads = 2;
    std::vector<std::string> tags;
    uint64_t memory = 0;
    core::FilmLayout layout;
    uint32_t samples = 0;
    std::chrono::milliseconds unit_time{0};
    uint64_t render_ns = 1'000'000;  ///< that it says a unit took
    std::string note;                ///< that it says of each film
    uint32_t thread = 0;             ///< ... and which thread had it
    uint64_t cache_bytes = 0;        ///< that heartbeats tell of, with other numbers of the cache
    /// What happens to a unit; true: it is delivered as usual.
    std::function<bool(ScriptedWorker&, const v1::LeasedUnit&)> meddle;
    /// Changes a film before it is delivered.
    std::function<void(core::Film&)> corrupt;
    std::vector<v1::LeasedUnit> claims{};  ///< that it says to have in hand
    bool reconnect = true;
    bool hold = false;  ///< units are rendered and never delivered
    /// Heartbeats, by a thread of their own, for what it holds; none without.
    std::chrono::milliseconds beat_every{0};
    v1::LeaseProgress::Stage stage = v1::LeaseProgress::STAGE_RENDERING;  ///< what they say
    bool moves = false;  ///< each tells of more samples
    /// How long it waits between streams; 50 ms without.
    std::optional<farm::Backoff> backoff = std::nullopt;
  };

  ScriptedWorker(const std::string& address, Script script)
      : address_(address), script_(std::move(script)), thread_([this] { live(); }) {}

  /// As kill -9: the connection breaks, and nobody comes back.
  ~ScriptedWorker() {
    over_ = true;
    {
      const std::lock_guard lock(mutex_);
      if (context_) context_->TryCancel();
    }
    thread_.join();
  }

  const std::string& id() const { return script_.id; }
  uint64_t delivered() const { return delivered_; }
  uint64_t acknowledged() const { return acknowledged_; }
  uint64_t adopted() const { return adopted_; }
  uint64_t stopped() const { return stopped_; }
  uint64_t streams() const { return streams_; }
  bool drained() const { return drained_; }
  std::vector<v1::Rejected> rejections() const {
    const std::lock_guard lock(mutex_);
    return rejections_;
  }
  /// The last one; empty before the first.
  v1::Welcome welcome() const {
    const std::lock_guard lock(mutex_);
    return welcome_;
  }
  grpc::Status last_status() const {
    const std::lock_guard lock(mutex_);
    return status_;
  }
  size_t unacknowledged() const {
    const std::lock_guard lock(mutex_);
    return kept_.size();
  }

  void write(const v1::WorkerMessage& message) {
    const std::lock_guard lock(write_mutex_);
    stream_->Write(message);
  }
  /// Renders a unit and delivers it.
  void deliver(const v1::LeasedUnit& leased) {
    std::this_thread::sleep_for(script_.unit_time);
    if (over_) return;
    const v1::WorkerMessage message = render(leased);
    ++delivered_;
    write(message);
  }
  /// Says why it cannot be rendered, and wants another; that it is not delivered, for `meddle`.
  bool fail(const v1::LeasedUnit& leased, const std::string& reason) {
    v1::WorkerMessage message;
    *message.mutable_failure()->mutable_unit() = leased;
    message.mutable_failure()->set_reason(reason);
    message.mutable_failure()->set_want(1);
    write(message);
    return false;
  }

 private:
  /// The unit's film in a message, which is kept.
  v1::WorkerMessage render(const v1::LeasedUnit& leased) {
    const auto unit = farm::from_wire(leased.unit());
    core::Film film = fake_film(*unit, script_.samples, script_.layout);
    if (script_.corrupt) script_.corrupt(film);
    v1::WorkerMessage message;
    v1::UnitResult& result = *message.mutable_result();
    *result.mutable_lease() = leased.lease();
    result.set_job(leased.job());
    *result.mutable_unit() = leased.unit();
    const std::vector<std::byte> bytes = core::encode_film(film);
    result.set_film(bytes.data(), bytes.size());
    result.set_digest(farm::to_wire(*farm::digest_from_hex(film.digest())));
    result.set_render_ns(script_.render_ns);
    if (!script_.note.empty()) result.add_notes(script_.note);
    result.set_thread(script_.thread);
    result.set_want(1);
    {
      const std::lock_guard lock(mutex_);
      kept_[key(leased)] = result;
    }
    return message;
  }

  using Stream = grpc::ClientReaderWriter<v1::WorkerMessage, v1::CoordinatorMessage>;

  static std::string key(const v1::LeasedUnit& leased) {
    v1::Unit unit = leased.unit();
    unit.clear_proof();
    return std::to_string(leased.job()) + "/" + unit.SerializeAsString();
  }

  void live() {
    while (!over_) {
      attend();
      if (!script_.reconnect) return;
      farm::Backoff::Duration wait = std::chrono::milliseconds(50);
      if (script_.backoff) wait = script_.backoff->next();
      const auto until = std::chrono::steady_clock::now() + wait;
      while (!over_ && std::chrono::steady_clock::now() < until) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      }
    }
  }

  void attend() {
    farm::Peer peer;
    peer.address = address_;
    const auto channel = farm::connect(peer);
    const auto stub = v1::Work::NewStub(*channel);
    auto context = std::make_unique<grpc::ClientContext>();
    farm::prepare(*context, script_.token, std::chrono::milliseconds(0));
    {
      const std::lock_guard lock(mutex_);
      context_ = std::move(context);
      if (over_) return;
    }
    stream_ = stub->Attend(context_.get());
    v1::WorkerMessage message;
    v1::Hello& hello = *message.mutable_hello();
    hello.set_protocol(farm::kProtocol);
    hello.set_worker_id(script_.id);
    hello.set_instance(script_.instance.empty() ? instance_ : script_.instance);
    hello.set_keeps_token(script_.keeps_token);
    hello.set_name(script_.name);
    hello.set_worker_class(script_.worker_class);
    hello.set_portable_class(script_.portable_class);
    hello.set_threads(script_.threads);
    for (const std::string& tag : script_.tags) hello.add_tags(tag);
    hello.set_memory_bytes(script_.memory);
    hello.set_want(script_.threads);
    for (const v1::LeasedUnit& claimed : script_.claims) *hello.add_in_hand() = claimed;
    for (const auto& [name, result] : kept_) {
      v1::LeasedUnit& held = *hello.add_in_hand();
      *held.mutable_lease() = result.lease();
      held.set_job(result.job());
      *held.mutable_unit() = result.unit();
    }
    v1::CoordinatorMessage reply;
    if (stream_->Write(message) && stream_->Read(&reply) && reply.has_welcome()) {
      {
        const std::lock_guard lock(mutex_);
        welcome_ = reply.welcome();
      }
      ++streams_;
      if (script_.backoff) script_.backoff->reset();
      for (const auto& [name, result] : kept_) {
        if (script_.hold) break;
        v1::WorkerMessage again;
        *again.mutable_result() = result;
        again.mutable_result()->set_want(0);
        stream_->Write(again);
      }
      std::atomic<bool> ended{false};
      std::thread heart([&] { beat(ended); });
      while (!over_ && stream_->Read(&reply)) on(reply);
      ended = true;
      heart.join();
    }
    stream_->WritesDone();
    const grpc::Status status = stream_->Finish();
    const std::lock_guard lock(mutex_);
    status_ = status;
  }

  void beat(const std::atomic<bool>& ended) {
    if (script_.beat_every.count() == 0) return;
    for (uint64_t number = 1; !ended; ++number) {
      v1::WorkerMessage message;
      v1::Heartbeat& heartbeat = *message.mutable_heartbeat();
      heartbeat.set_number(number);
      heartbeat.set_cache_bytes(script_.cache_bytes);
      heartbeat.set_cache_limit_bytes(1000);
      heartbeat.set_cache_hits(7);
      heartbeat.set_cache_misses(3);
      {
        const std::lock_guard lock(mutex_);
        for (const auto& [name, result] : kept_) {
          v1::LeaseProgress& lease = *message.mutable_heartbeat()->add_leases();
          *lease.mutable_lease() = result.lease();
          lease.set_stage(script_.stage);
          if (script_.moves) lease.set_samples_done(number);
        }
      }
      write(message);
      std::this_thread::sleep_for(script_.beat_every);
    }
  }

  void on(const v1::CoordinatorMessage& message) {
    if (message.has_lease()) {
      for (const v1::Unit& unit : message.lease().units()) {
        v1::LeasedUnit leased;
        *leased.mutable_lease() = message.lease().lease();
        leased.set_job(message.lease().job());
        *leased.mutable_unit() = unit;
        if (message.lease().adopted()) {
          ++adopted_;
          continue;
        }
        if (script_.meddle && !script_.meddle(*this, leased)) continue;
        if (script_.hold) {
          render(leased);
        } else {
          deliver(leased);
        }
      }
    } else if (message.has_acknowledge()) {
      const std::lock_guard lock(mutex_);
      kept_.erase(key(message.acknowledge().unit()));
      ++acknowledged_;
    } else if (message.has_rejected()) {
      {
        const std::lock_guard lock(mutex_);
        rejections_.push_back(message.rejected());
        if (message.rejected().reason() != v1::Rejected::REASON_NOT_NOW) {
          kept_.erase(key(message.rejected().unit()));
          return;
        }
      }
      std::this_thread::sleep_for(
          std::chrono::milliseconds(std::min(50U, message.rejected().retry_after_ms())));
      const auto kept = kept_.find(key(message.rejected().unit()));
      if (kept == kept_.end()) return;
      v1::WorkerMessage again;
      *again.mutable_result() = kept->second;
      again.mutable_result()->set_want(0);
      write(again);
    } else if (message.has_stop()) {
      const std::lock_guard lock(mutex_);
      if (script_.hold) kept_.erase(key(message.stop().unit()));
      ++stopped_;
    } else if (message.has_drain()) {
      drained_ = true;
    }
  }

  const std::string address_;
  Script script_;
  const std::string instance_ = *core::random_id();
  std::atomic<bool> over_{false};
  std::atomic<uint64_t> delivered_{0};
  std::atomic<uint64_t> acknowledged_{0};
  std::atomic<uint64_t> adopted_{0};
  std::atomic<uint64_t> stopped_{0};
  std::atomic<uint64_t> streams_{0};
  std::atomic<bool> drained_{false};
  mutable std::mutex mutex_;
  std::mutex write_mutex_;
  std::unique_ptr<grpc::ClientContext> context_;
  std::map<std::string, v1::UnitResult> kept_;
  std::vector<v1::Rejected> rejections_;
  v1::Welcome welcome_;
  grpc::Status status_;
  std::unique_ptr<Stream> stream_;
  std::thread thread_;
};

}  // namespace hyades::coordinator
