#include "coordinator/services/work_service.h"

#include <deque>
#include <memory>
#include <mutex>
#include <utility>

namespace hyades::coordinator {
namespace {

/// A worker that does not read for so long that this many messages wait is cut off.
constexpr size_t kMostWaiting = 100'000;

/// The stream's writing side, which outlives the stream as long as the brain holds it.
class Link final : public WorkerLink {
 public:
  /// What the reactor does for it; null once the call is over.
  class Wire {
   public:
    virtual ~Wire() = default;
    virtual void write(const v1::CoordinatorMessage& message) = 0;
    virtual void finish(const grpc::Status& status) = 0;
  };

  explicit Link(Wire& wire) : wire_(&wire) {}

  void send(v1::CoordinatorMessage message) override {
    const std::lock_guard lock(mutex_);
    if (wire_ == nullptr || closed_) return;
    queue_.push_back(std::move(message));
    if (queue_.size() > kMostWaiting) {
      queue_.resize(writing_ ? 1 : 0);
      close_locked({grpc::StatusCode::RESOURCE_EXHAUSTED, "the worker does not read"});
    } else {
      proceed();
    }
  }

  void close(const grpc::Status& status) override {
    const std::lock_guard lock(mutex_);
    if (wire_ != nullptr && !closed_) close_locked(status);
  }

  void written(bool ok) {
    const std::lock_guard lock(mutex_);
    writing_ = false;
    if (!queue_.empty()) queue_.pop_front();
    if (!ok) queue_.clear();
    if (wire_ != nullptr) proceed();
  }

  /// The call is over: nothing more is written.
  void detach() {
    const std::lock_guard lock(mutex_);
    wire_ = nullptr;
    queue_.clear();
  }

 private:
  void close_locked(const grpc::Status& status) {
    closed_ = true;
    status_ = status;
    proceed();
  }

  /// Starting an operation never calls back on this thread, so the lock may be held.
  void proceed() {
    if (writing_) return;
    if (!queue_.empty()) {
      writing_ = true;
      wire_->write(queue_.front());
    } else if (closed_ && !finished_) {
      finished_ = true;
      wire_->finish(status_);
    }
  }

  std::mutex mutex_;
  Wire* wire_;
  std::deque<v1::CoordinatorMessage> queue_;  ///< the first is being written while writing_
  bool writing_ = false;
  bool closed_ = false;
  bool finished_ = false;
  grpc::Status status_;
};

class Attendance final : public grpc::ServerBidiReactor<v1::WorkerMessage, v1::CoordinatorMessage>,
                         public Link::Wire {
 public:
  Attendance(Brain& brain, const grpc::Status& admitted)
      : brain_(brain), link_(std::make_shared<Link>(*this)) {
    if (admitted.ok()) {
      StartRead(&message_);
    } else {
      link_->close(admitted);
    }
  }

  void OnReadDone(bool ok) override {
    if (!ok) {
      // The worker has said all, or is gone.
      link_->close(grpc::Status::OK);
      return;
    }
    if (!attached_) {
      grpc::Status status{grpc::StatusCode::INVALID_ARGUMENT, "a stream begins with Hello"};
      if (message_.has_hello()) status = brain_.attach(message_.hello(), link_, worker_);
      if (!status.ok()) {
        link_->close(status);
        return;
      }
      attached_ = true;
    } else {
      brain_.receive(worker_, link_.get(), message_);
    }
    StartRead(&message_);
  }

  void OnWriteDone(bool ok) override { link_->written(ok); }

  void OnDone() override {
    link_->detach();
    if (attached_) brain_.detach(worker_, link_.get());
    delete this;
  }

 private:
  void write(const v1::CoordinatorMessage& message) override { StartWrite(&message); }
  void finish(const grpc::Status& status) override { Finish(status); }

  Brain& brain_;
  const std::shared_ptr<Link> link_;
  v1::WorkerMessage message_;
  WorkerId worker_{};
  bool attached_ = false;
};

}  // namespace

grpc::ServerBidiReactor<v1::WorkerMessage, v1::CoordinatorMessage>* WorkService::Attend(
    grpc::CallbackServerContext* context) {
  return new Attendance(brain_, admission_.check(*context));
}

}  // namespace hyades::coordinator
