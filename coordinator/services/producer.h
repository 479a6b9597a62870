#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include <grpcpp/alarm.h>
#include <grpcpp/server_context.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/status.h>

#include "coordinator/access/caller.h"
#include "coordinator/controller/within_memory.h"
#include "coordinator/operations/executors.h"
#include "coordinator/services/admission.h"
#include "core/base/mutex.h"
#include "farm/message_bytes.h"

namespace hyades::coordinator {

/// How long a stream waits for its reader to take a message; then it is broken off.
inline constexpr std::chrono::milliseconds kReaderPatience{60'000};

/// Lets any thread wake a stream, which may be over already.
class Waker {
 public:
  virtual ~Waker() = default;
  /// Has the stream ask again what to send next; nothing where it is over.
  virtual void wake() = 0;
};

/// The call by which a stream goes out. Neither function calls the stream back on this thread.
class OutgoingCall {
 public:
  virtual ~OutgoingCall() = default;
  /// Sends `message`, which stays as it is until OutgoingStream::written().
  virtual void write(const grpc::ByteBuffer& message) = 0;
  virtual void finish(const grpc::Status& status) = 0;
};

/// A stream of messages to a client. Whoever has the call tells it what becomes of that.
class OutgoingStream {
 public:
  virtual ~OutgoingStream() = default;
  /// Ends the stream when its caller's token does. Called once.
  virtual void guard(const Admission& admission, const Caller& caller) = 0;
  /// Called once, when everything is set up. `call` lives until end().
  virtual void begin(OutgoingCall& call) = 0;
  /// What is read already and comes with later messages [bytes]. Asked from within write().
  virtual uint64_t bytes_ahead() const { return 0; }
  /// The message is on its way; or, where not `ok`, the client is gone.
  virtual void written(bool ok) = 0;
  /// The call has been broken off. By any thread; perhaps before begin().
  virtual void cancel() = 0;
  /// The call is over. The stream deletes itself.
  virtual void end() = 0;
};

/// A stream whose messages are made as fast as its client reads: next() is called again when the
/// last message is on its way, or, after it had nothing, when somebody wakes the stream.
/// Where it may have to wait (for the disk, say) a thread of the pool calls it. Broken off where
/// the client does not read, or the pool has too much to do. Deletes itself.
template <class Message>
class Producer : public OutgoingStream {
 public:
  /// What next() has done.
  enum class Step {
    message,       ///< put the next message
    wait,          ///< nothing: there is none before somebody wakes the stream
    needs_thread,  ///< nothing: it may have to wait, and must not
    end            ///< put the status with which the stream ends
  };

  void begin(OutgoingCall& call) override {
    call_ = &call;
    advance(false);
  }

  void guard(const Admission& admission, const Caller& caller) override {
    owner_ = owner_of(caller).name;
    visit_ = admission.visit(
        caller, [handle = handle_](const grpc::Status& why) { handle->send_away(why); });
  }

  void written(bool ok) override {
    too_slow_.reset();
    if (ok) {
      advance(false);
    } else {
      call_->finish({grpc::StatusCode::CANCELLED, "the client is gone"});
    }
  }
  void cancel() override {
    {
      const core::MutexLock lock(mutex_);
      cancelled_ = true;
    }
    wake();
  }
  void end() override {
    handle_->drop();
    over();
    delete this;
  }

 protected:
  Producer(grpc::CallbackServerContext& context, farm::ThreadPool& pool,
           std::chrono::milliseconds patience = kReaderPatience)
      : handle_(std::make_shared<Handle>(this)),
        context_(context),
        pool_(pool),
        patience_(patience) {}

  /// Puts the next message into `message`, which is empty, or the end into `status`. Where
  /// `may_wait` is false it must not wait; after needs_thread it is called again, and may. Never
  /// called twice at once.
  virtual Step next(Message& message, grpc::Status& status, bool may_wait) = 0;
  /// Called once, when the call is over: what would wake the stream can be let go of.
  virtual void over() {}

  std::shared_ptr<Waker> waker() const { return handle_; }

 private:
  class Handle final : public Waker {
   public:
    explicit Handle(Producer* producer) : producer_(producer) {}
    void wake() override {
      const core::MutexLock lock(mutex_);
      if (producer_ != nullptr) producer_->wake();
    }
    void send_away(const grpc::Status& why) {
      const core::MutexLock lock(mutex_);
      if (producer_ != nullptr) producer_->send_away(why);
    }
    void break_off() {
      const core::MutexLock lock(mutex_);
      if (producer_ != nullptr) producer_->context_.TryCancel();
    }
    void drop() {
      const core::MutexLock lock(mutex_);
      producer_ = nullptr;
    }

   private:
    core::Mutex mutex_;
    Producer* producer_ HYADES_GUARDED_BY(mutex_);
  };

  void send_away(const grpc::Status& why) {
    {
      const core::MutexLock lock(mutex_);
      end_status_ = why;
    }
    wake();
  }

  void wake() {
    {
      const core::MutexLock lock(mutex_);
      woken_ = true;
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
        const core::MutexLock lock(mutex_);
        woken_ = false;
        cancelled = cancelled_;
        status = end_status_;
      }
      Step step = Step::end;
      Message message;  // not kept: an emptied message holds on to its memory
      if (cancelled) {
        status = {grpc::StatusCode::CANCELLED, "the client is gone"};
      } else if (status.ok()) {
        status = within_memory([&] {
          grpc::Status end;
          step = next(message, end, may_wait);
          return end;
        });
        if (step == Step::message) {
          status = farm::serialise(message, bytes_);
          if (!status.ok()) step = Step::end;
        }
      }
      switch (step) {
        case Step::message:
          return write();
        case Step::end:
          return call_->finish(status);
        case Step::needs_thread:
          if (!pool_.submit([this] { advance(true); }, owner_)) call_->finish(crowded());
          return;
        case Step::wait:
          break;
      }
      const core::MutexLock lock(mutex_);
      if (woken_) continue;
      busy_ = false;
      return;
    }
  }

  void write() {
    too_slow_ = std::make_unique<grpc::Alarm>();
    too_slow_->Set(std::chrono::system_clock::now() + patience_, [handle = handle_](bool rang) {
      if (rang) handle->break_off();
    });
    call_->write(bytes_);
  }

  const std::shared_ptr<Handle> handle_;
  grpc::CallbackServerContext& context_;
  farm::ThreadPool& pool_;
  const std::chrono::milliseconds patience_;
  OutgoingCall* call_ = nullptr;           ///< since begin()
  std::unique_ptr<grpc::Alarm> too_slow_;  ///< while a message is on its way
  grpc::ByteBuffer bytes_;                 ///< the message on its way
  core::Mutex mutex_;
  bool busy_ HYADES_GUARDED_BY(mutex_) =
      true;  ///< not begun, next() or a write is going on, or all is over
  bool woken_ HYADES_GUARDED_BY(mutex_) = false;  ///< since next() was last called
  bool cancelled_ HYADES_GUARDED_BY(mutex_) = false;
  grpc::Status end_status_ HYADES_GUARDED_BY(mutex_);  ///< not OK: the caller may stay no longer
  std::unique_ptr<Visit> visit_;                       ///< of who reads
  std::string owner_;                                  ///< whose turn it takes in the pool
};

}  // namespace hyades::coordinator
