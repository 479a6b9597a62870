#pragma once

#include <chrono>
#include <memory>
#include <mutex>

#include <grpcpp/alarm.h>
#include <grpcpp/server_context.h>
#include <grpcpp/support/server_callback.h>
#include <grpcpp/support/status.h>

#include "coordinator/operations/executors.h"
#include "coordinator/services/admission.h"
#include "coordinator/services/raw.h"

namespace hyades::coordinator {

/// What a stream waits for while its reader takes nothing; then it is broken off.
inline constexpr std::chrono::milliseconds kReaderPatience{60'000};

/// Lets others wake a stream that may be over already.
class Poker {
 public:
  virtual ~Poker() = default;
  virtual void poke() = 0;
};

/// A stream of messages to a client. Deletes itself.
class OutgoingStream : public grpc::ServerWriteReactor<grpc::ByteBuffer> {
 public:
  /// Ends the stream when its caller's token does. Called once.
  virtual void guard(const Admission& admission, const Caller& caller) = 0;
  /// Called once, when everything is set up. gRPC reports nothing, so the end neither, before the
  /// service's method has returned.
  virtual void begin() = 0;
};

/// A stream that says no.
class Refusal final : public grpc::ServerWriteReactor<grpc::ByteBuffer> {
 public:
  explicit Refusal(const grpc::Status& status) { Finish(status); }
  void OnDone() override { delete this; }
};

/// A stream whose messages are produced as fast as it reads: next() is called again when the
/// last message is on its way, or, after it had nothing, when somebody pokes. Where it would have
/// to wait (for the disk, say) it has itself called by a thread of the pool. Broken off where the
/// client does not read, or the pool has too much to do. Deletes itself.
template <class Message>
class Producer : public OutgoingStream {
 public:
  enum class Step { message, wait, hand, end };

  void begin() override { advance(false); }

  void guard(const Admission& admission, const Caller& caller) override {
    visit_ = admission.visit(
        caller, [handle = handle_](const grpc::Status& why) { handle->send_away(why); });
  }

  void OnWriteDone(bool ok) override {
    too_slow_.reset();
    if (ok) {
      advance(false);
    } else {
      Finish({grpc::StatusCode::CANCELLED, "the client is gone"});
    }
  }
  void OnCancel() override {
    {
      const std::lock_guard lock(mutex_);
      cancelled_ = true;
    }
    poke();
  }
  void OnDone() override {
    handle_->drop();
    over();
    delete this;
  }

 protected:
  Producer(grpc::CallbackServerContext& context, ThreadPool& pool,
           std::chrono::milliseconds patience = kReaderPatience)
      : handle_(std::make_shared<Handle>(this)),
        context_(context),
        pool_(pool),
        patience_(patience) {}

  /// Puts the next message, or, where it says end, the status. May say `hand` where it may not
  /// wait: then it is called again, with nothing in `message`, and may. Never called twice at once.
  virtual Step next(Message& message, grpc::Status& status, bool may_wait) = 0;
  /// The call is over: nobody may poke any more.
  virtual void over() {}

  std::shared_ptr<Poker> poker() const { return handle_; }

 private:
  class Handle final : public Poker {
   public:
    explicit Handle(Producer* producer) : producer_(producer) {}
    void poke() override {
      const std::lock_guard lock(mutex_);
      if (producer_ != nullptr) producer_->poke();
    }
    void send_away(const grpc::Status& why) {
      const std::lock_guard lock(mutex_);
      if (producer_ != nullptr) producer_->send_away(why);
    }
    void break_off() {
      const std::lock_guard lock(mutex_);
      if (producer_ != nullptr) producer_->context_.TryCancel();
    }
    void drop() {
      const std::lock_guard lock(mutex_);
      producer_ = nullptr;
    }

   private:
    std::mutex mutex_;
    Producer* producer_;
  };

  void send_away(const grpc::Status& why) {
    {
      const std::lock_guard lock(mutex_);
      farewell_ = why;
    }
    poke();
  }

  void poke() {
    {
      const std::lock_guard lock(mutex_);
      poked_ = true;
      if (busy_) return;
      busy_ = true;
    }
    advance(false);
  }

  void advance(bool may_wait) {
    for (;;) {
      grpc::Status status;
      bool cancelled = false;
      {
        const std::lock_guard lock(mutex_);
        poked_ = false;
        cancelled = cancelled_;
        status = farewell_;
      }
      Step step = Step::end;
      message_.Clear();
      if (cancelled) {
        status = {grpc::StatusCode::CANCELLED, "the client is gone"};
      } else if (status.ok()) {
        status = within_memory([&] {
          grpc::Status end;
          step = next(message_, end, may_wait);
          return end;
        });
        if (step == Step::message) {
          status = serialise(message_, bytes_);
          if (!status.ok()) step = Step::end;
        }
      }
      if (step == Step::message) return write();
      if (step == Step::end) return Finish(status);
      if (step == Step::hand) {
        if (!pool_.submit([this] { advance(true); })) Finish(crowded());
        return;
      }
      const std::lock_guard lock(mutex_);
      if (poked_) continue;
      busy_ = false;
      return;
    }
  }

  void write() {
    too_slow_ = std::make_unique<grpc::Alarm>();
    too_slow_->Set(std::chrono::system_clock::now() + patience_, [handle = handle_](bool rang) {
      if (rang) handle->break_off();
    });
    StartWrite(&bytes_);
  }

  const std::shared_ptr<Handle> handle_;
  grpc::CallbackServerContext& context_;
  ThreadPool& pool_;
  const std::chrono::milliseconds patience_;
  std::unique_ptr<grpc::Alarm> too_slow_;  ///< while a message is on its way
  Message message_;
  grpc::ByteBuffer bytes_;  ///< the message on its way
  std::mutex mutex_;
  bool busy_ = true;    ///< not begun, next() or a write is going on, or all is over
  bool poked_ = false;  ///< since next() was last called
  bool cancelled_ = false;
  grpc::Status farewell_;         ///< not OK: the caller may stay no longer
  std::unique_ptr<Visit> visit_;  ///< of who reads
};

}  // namespace hyades::coordinator
