// One stream per worker.
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "coordinator/access/caller.h"
#include "coordinator/controller/controller.h"
#include "coordinator/services/service.h"
#include "coordinator/services/worker_bytes.h"
#include "core/base/mutex.h"
#include "farm/byte_budget.h"
#include "farm/message_bytes.h"
#include "farm/wire.h"

namespace hyades::coordinator {
namespace {

/// A worker that does not read for so long that this much waits for it is cut off.
constexpr size_t kMostWaiting = 20'000;
constexpr uint64_t kMostWaitingBytes = uint64_t{32} << 20U;
/// So much may wait for every worker, whatever waits for others.
constexpr uint64_t kFewWaitingBytes = uint64_t{64} << 10U;

/// The stream's writing side, which outlives the stream as long as the controller holds it.
class Link final : public WorkerLink {
 public:
  /// What the reactor does for it; null once the call is over.
  class Wire {
   public:
    virtual ~Wire() = default;
    virtual void write(const grpc::ByteBuffer& message) = 0;
    virtual void finish(const grpc::Status& status) = 0;
    virtual void cancel() = 0;
  };

  /// `waiting`: what much of what waits is counted in, for `owner`; outlives the stream.
  Link(Wire& wire, farm::ByteBudget& waiting, farm::ByteBudget::Owner owner)
      : wire_(&wire), counted_(waiting, std::move(owner)) {}

  void send(grpc::ByteBuffer message) override {
    const core::MutexLock lock(mutex_);
    if (wire_ == nullptr || closed_) return;
    waiting_ += message.Length();
    queue_.push_back(std::move(message));
    // One message may be as large as it is: a large job's files.
    const bool several = queue_.size() > 2;
    const bool much = (waiting_ > kMostWaitingBytes || !count()) && several;
    if (queue_.size() > kMostWaiting || much) {
      forget_waiting();
      close_locked({grpc::StatusCode::RESOURCE_EXHAUSTED, "the worker does not read"});
      wire_->cancel();  // or the message on its way would keep the stream open
    } else {
      proceed();
    }
  }

  void close(const grpc::Status& status) override {
    const core::MutexLock lock(mutex_);
    if (wire_ != nullptr && !closed_) close_locked(status);
  }

  void written(bool ok) {
    const core::MutexLock lock(mutex_);
    writing_ = false;
    if (!ok) forget_waiting();
    if (wire_ != nullptr) proceed();
  }

  /// Ends the stream without regard to what waits to be sent.
  void cut(const grpc::Status& status) {
    const core::MutexLock lock(mutex_);
    if (wire_ == nullptr || finished_) return;
    forget_waiting();
    if (writing_) wire_->cancel();  // a worker that does not read
    closed_ = true;
    status_ = status;
    proceed();
  }

  /// The call is over: nothing more is written.
  void detach() {
    const core::MutexLock lock(mutex_);
    wire_ = nullptr;
    forget_waiting();
  }

 private:
  void close_locked(const grpc::Status& status) HYADES_REQUIRES(mutex_) {
    closed_ = true;
    status_ = status;
    proceed();
  }

  /// Whether there is room for what waits now; what there is no room for is not counted.
  bool count() HYADES_REQUIRES(mutex_) {
    return counted_.try_hold(waiting_ > kFewWaitingBytes ? waiting_ : 0);
  }
  void forget_waiting() HYADES_REQUIRES(mutex_) {
    queue_.clear();
    waiting_ = 0;
    count();
  }

  /// Starting an operation never calls back on this thread, so the lock may be held.
  void proceed() HYADES_REQUIRES(mutex_) {
    if (writing_) return;
    if (!queue_.empty()) {
      writing_ = true;
      bytes_ = queue_.front();
      waiting_ -= bytes_.Length();
      queue_.pop_front();
      count();
      wire_->write(bytes_);
    } else if (closed_ && !finished_) {
      finished_ = true;
      wire_->finish(status_);
    }
  }

  core::Mutex mutex_;
  Wire* wire_ HYADES_GUARDED_BY(mutex_);
  farm::ByteBudget::Share counted_ HYADES_GUARDED_BY(mutex_);
  std::deque<grpc::ByteBuffer> queue_ HYADES_GUARDED_BY(mutex_);
  uint64_t waiting_ HYADES_GUARDED_BY(mutex_) = 0;    ///< bytes in queue_
  grpc::ByteBuffer bytes_ HYADES_GUARDED_BY(mutex_);  ///< the message that is being written
  bool writing_ HYADES_GUARDED_BY(mutex_) = false;
  bool closed_ HYADES_GUARDED_BY(mutex_) = false;
  bool finished_ HYADES_GUARDED_BY(mutex_) = false;
  grpc::Status status_ HYADES_GUARDED_BY(mutex_);
};

/// A worker's stream: passes what the worker says to the controller, and ends with its token.
class WorkerStream final : public grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>,
                           public Link::Wire {
 public:
  /// `caller` has been admitted, or not.
  WorkerStream(Controller& controller, grpc::CallbackServerContext& context,
               const Admission& admission, const Caller& caller, const grpc::Status& admitted,
               farm::ByteBudget& waiting)
      : controller_(controller),
        context_(context),
        admission_(admission),
        caller_(caller),
        link_(std::make_shared<Link>(*this, waiting, owner_of(caller))) {
    if (admitted.ok()) {
      visit_ = admission.visit(caller, [this](const grpc::Status& why) {
        sent_away_ = true;
        link_->cut(why);
      });
      StartRead(&bytes_);
    } else {
      link_->close(admitted);
    }
  }

  void OnReadDone(bool ok) override {
    if (sent_away_) return;  // what it still says is not heard
    if (!ok) {
      // The worker has said all, or is gone.
      link_->close(grpc::Status::OK);
      return;
    }
    v1::WorkerMessage message;  // not kept: an emptied message holds on to its memory
    if (const grpc::Status read = take(message); !read.ok()) {
      link_->close(read);
      return;
    }
    if (!attached_) {
      grpc::Status status{grpc::StatusCode::INVALID_ARGUMENT, "a stream begins with Hello"};
      if (message.has_hello()) status = attach(message.hello());
      if (!status.ok()) {
        link_->close(status);
        return;
      }
      attached_ = true;
    } else {
      controller_.workers().receive(worker_, link_.get(), message);
    }
    StartRead(&bytes_);
  }

  void OnWriteDone(bool ok) override { link_->written(ok); }

  void OnDone() override {
    visit_.reset();
    link_->detach();
    if (attached_) controller_.workers().detach(worker_, link_.get());
    delete this;
  }

 private:
  grpc::Status attach(const v1::Hello& hello) {
    WorkerCredential credential;
    if (grpc::Status known = admission_.admit_worker(caller_, hello, credential); !known.ok()) {
      return known;
    }
    const WorkerPass pass{caller_.term,
                          std::move(credential.name),
                          std::move(credential.origin),
                          std::move(credential.machine_token),
                          std::move(credential.owner),
                          std::move(credential.joined_with),
                          credential.machines};
    return controller_.workers().attach(hello, link_, worker_, pass);
  }

  /// What has come, parsed: only what may be large may be.
  grpc::Status take(v1::WorkerMessage& message) {
    const auto besides = bytes_besides_film(bytes_);
    if (besides && *besides > farm::kMaxWorkerTalkBytes) {
      return {grpc::StatusCode::INVALID_ARGUMENT,
              fmt::format("a worker's message has {} bytes besides a film: {} are the most",
                          *besides, farm::kMaxWorkerTalkBytes)};
    }
    if (!besides) {
      return {grpc::StatusCode::INVALID_ARGUMENT, "these bytes are not a worker's message"};
    }
    const grpc::Status read = farm::parse(bytes_, farm::kMaxResultBytes, message);
    bytes_.Clear();
    return read;
  }

  void write(const grpc::ByteBuffer& message) override { StartWrite(&message); }
  void finish(const grpc::Status& status) override { Finish(status); }
  void cancel() override { context_.TryCancel(); }

  Controller& controller_;
  grpc::CallbackServerContext& context_;
  const Admission& admission_;
  const Caller caller_;
  const std::shared_ptr<Link> link_;
  std::unique_ptr<Visit> visit_;
  std::atomic<bool> sent_away_{false};  ///< its token is of no use any more
  grpc::ByteBuffer bytes_;
  WorkerId worker_{};
  bool attached_ = false;
};

}  // namespace

void add_worker_stream(Service& service) {
  service.add_bidi_stream("Work/Attend", [&service](Service::Context& context, const Caller& caller,
                                                    const grpc::Status& admitted) {
    return new WorkerStream(service.backend().controller, context, service.admission(), caller,
                            admitted, service.waiting());
  });
}

}  // namespace hyades::coordinator
