#include "coordinator/services/request_call.h"

#include <utility>

#include <grpcpp/support/status.h>

#include "core/base/mutex.h"

namespace hyades::coordinator {

/// Who ends the waiting for a message: the message or the alarm, which may ring when the call is
/// over.
class RequestCall::Patience {
 public:
  explicit Patience(RequestCall& call) : call_(&call) {}

  /// Whether the call goes on; it does not where the patience has run out.
  bool end() {
    const core::MutexLock lock(mutex_);
    return std::exchange(call_, nullptr) != nullptr;
  }
  /// Starting an operation never calls back on this thread, so the lock may be held.
  void run_out() {
    const core::MutexLock lock(mutex_);
    if (RequestCall* call = std::exchange(call_, nullptr)) {
      call->Finish({grpc::StatusCode::DEADLINE_EXCEEDED, "the request did not come to its end"});
    }
  }

 private:
  core::Mutex mutex_;
  RequestCall* call_ HYADES_GUARDED_BY(mutex_);  ///< null: nobody waits any more
};

RequestCall::RequestCall() : patience_(std::make_shared<Patience>(*this)) {}

RequestCall::~RequestCall() = default;

void RequestCall::ask(std::chrono::milliseconds patience) {
  StartRead(&asked_);
  alarm_.emplace();
  alarm_->Set(std::chrono::system_clock::now() + patience, [waiting = patience_](bool rang) {
    if (rang) waiting->run_out();
  });
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

}  // namespace hyades::coordinator
