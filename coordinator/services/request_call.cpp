#include "coordinator/services/request_call.h"

#include <functional>
#include <utility>

#include <grpcpp/support/status.h>

#include "core/base/mutex.h"

namespace hyades::coordinator {

/// Who ends the waiting: what is waited for or the alarm, which may ring when the call is over.
class RequestCall::Patience {
 public:
  explicit Patience(std::function<void()> give_up) : give_up_(std::move(give_up)) {}

  /// Whether the call goes on; it does not where the patience has run out.
  bool end() {
    const core::MutexLock lock(mutex_);
    return std::exchange(waits_, false);
  }
  /// Starting an operation never calls back on this thread, so the lock may be held.
  void run_out() {
    const core::MutexLock lock(mutex_);
    if (std::exchange(waits_, false)) give_up_();
  }

 private:
  const std::function<void()> give_up_;
  core::Mutex mutex_;
  bool waits_ HYADES_GUARDED_BY(mutex_) = true;
};

RequestCall::RequestCall(grpc::CallbackServerContext& context) : context_(context) {}

RequestCall::~RequestCall() = default;

void RequestCall::wait(std::chrono::milliseconds time, std::shared_ptr<Patience> patience) {
  patience_ = std::move(patience);
  alarm_.emplace();
  alarm_->Set(std::chrono::system_clock::now() + time, [waiting = patience_](bool rang) {
    if (rang) waiting->run_out();
  });
}

void RequestCall::ask(std::chrono::milliseconds patience) {
  StartRead(&asked_);
  wait(patience, std::make_shared<Patience>([this] {
         Finish({grpc::StatusCode::DEADLINE_EXCEEDED, "the request did not come to its end"});
       }));
}

void RequestCall::answer(const grpc::ByteBuffer& message, std::chrono::milliseconds patience) {
  // First: the call may be over, and gone, once the answer is on its way.
  wait(patience, std::make_shared<Patience>([this] { context_.TryCancel(); }));
  StartWriteAndFinish(&message, grpc::WriteOptions(), grpc::Status::OK);
}

void RequestCall::OnReadDone(bool ok) {
  if (!patience_->end()) return;  // Finish() has been called
  alarm_.reset();
  if (ok) {
    take();
  } else {
    Finish({grpc::StatusCode::CANCELLED, "the call ended before its message had come"});
  }
}

void RequestCall::OnDone() {
  if (patience_) patience_->end();
  delete this;
}

}  // namespace hyades::coordinator
