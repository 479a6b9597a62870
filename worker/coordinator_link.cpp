#include "worker/coordinator_link.h"

#include <chrono>
#include <deque>
#include <utility>

#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>

#include "core/base/mutex.h"
#include "farm/channel.h"
#include "farm/wire_status.h"
#include "hyades/v1/work.grpc.pb.h"

namespace hyades::worker {
namespace {

StreamEnd meaning_of(grpc::StatusCode code) {
  switch (code) {
    case grpc::StatusCode::UNAUTHENTICATED:
      return StreamEnd::unknown;
    case grpc::StatusCode::PERMISSION_DENIED:
    case grpc::StatusCode::FAILED_PRECONDITION:
    case grpc::StatusCode::UNIMPLEMENTED:
      return StreamEnd::refused;
    case grpc::StatusCode::ALREADY_EXISTS:
      return StreamEnd::id_taken;
    default:
      return StreamEnd::broken;
  }
}

}  // namespace

struct CoordinatorLink::State {
  std::shared_ptr<grpc::Channel> channel;
  std::unique_ptr<v1::Work::Stub> stub;
  Owner* owner = nullptr;
  core::Mutex mutex;
  core::CondVar closed;
  std::string token HYADES_GUARDED_BY(mutex);
  std::shared_ptr<Stream> stream HYADES_GUARDED_BY(mutex);  ///< the one that is open
  /// Streams whose end the owner has not heard of.
  int live HYADES_GUARDED_BY(mutex) = 0;
};

/// One call. It keeps itself alive until gRPC is done with it.
class CoordinatorLink::Stream
    : public grpc::ClientBidiReactor<v1::WorkerMessage, v1::CoordinatorMessage> {
 public:
  explicit Stream(std::shared_ptr<State> state) : state_(std::move(state)) {
    const core::MutexLock lock(state_->mutex);
    farm::prepare(context_, state_->token, std::chrono::milliseconds(0));
  }

  void start() {
    state_->stub->async()->Attend(&context_, this);
    AddHold();  // writes begin outside of reactions; let go of when the stream is broken
    StartRead(&incoming_);
    StartCall();
  }

  void send(v1::WorkerMessage message) {
    const core::MutexLock lock(mutex_);
    if (broken_ || finishing_) return;
    outgoing_.push_back(std::move(message));
    write_next_locked();
  }

  bool flowing() const {
    const core::MutexLock lock(mutex_);
    return outgoing_.empty() && !writing_;
  }

  void finish() {
    const core::MutexLock lock(mutex_);
    if (broken_ || finishing_) return;
    finishing_ = true;
    write_next_locked();
  }

  void cancel() { context_.TryCancel(); }

  void OnReadDone(bool ok) override {
    if (ok) {
      state_->owner->stream_says(std::move(incoming_));
      incoming_.Clear();
      StartRead(&incoming_);
      return;
    }
    {
      const core::MutexLock lock(mutex_);
      broken_ = true;
    }
    RemoveHold();
  }

  void OnWriteDone(bool /*ok: a broken stream is noticed by reading*/) override {
    const core::MutexLock lock(mutex_);
    writing_ = false;
    if (!broken_) write_next_locked();
  }

  void OnDone(const grpc::Status& status) override {
    const std::shared_ptr<State> state = state_;
    std::shared_ptr<Stream> self;  // outlives this function's last line
    {
      const core::MutexLock lock(state->mutex);
      self = std::move(state->stream);
      state->stream.reset();
    }
    state->owner->stream_ended(meaning_of(status.error_code()),
                               status.ok() ? "it was closed" : status.error_message(),
                               std::chrono::milliseconds(farm::detail_of(status).retry_after_ms()));
    const core::MutexLock lock(state->mutex);
    --state->live;
    state->closed.notify_all();
  }

 private:
  void write_next_locked() HYADES_REQUIRES(mutex_) {
    if (writing_) return;
    if (!outgoing_.empty()) {
      writing_ = true;
      current_ = std::move(outgoing_.front());
      outgoing_.pop_front();
      StartWrite(&current_);
    } else if (finishing_ && !half_closed_) {
      half_closed_ = true;
      StartWritesDone();
    }
  }

  const std::shared_ptr<State> state_;
  grpc::ClientContext context_;
  v1::CoordinatorMessage incoming_;

  mutable core::Mutex mutex_;
  std::deque<v1::WorkerMessage> outgoing_ HYADES_GUARDED_BY(mutex_);
  v1::WorkerMessage current_ HYADES_GUARDED_BY(mutex_);
  bool writing_ HYADES_GUARDED_BY(mutex_) = false;
  bool broken_ HYADES_GUARDED_BY(mutex_) = false;
  bool finishing_ HYADES_GUARDED_BY(mutex_) = false;
  bool half_closed_ HYADES_GUARDED_BY(mutex_) = false;
};

CoordinatorLink::CoordinatorLink(std::shared_ptr<grpc::Channel> channel, std::string token,
                                 Owner& owner)
    : state_(std::make_shared<State>()) {
  state_->channel = std::move(channel);
  state_->stub = v1::Work::NewStub(state_->channel);
  state_->token = std::move(token);
  state_->owner = &owner;
}

CoordinatorLink::~CoordinatorLink() {
  const core::MutexLock lock(state_->mutex);
  if (state_->stream) state_->stream->cancel();
  while (state_->live > 0) state_->closed.wait(state_->mutex);
}

void CoordinatorLink::set_token(std::string token) {
  const core::MutexLock lock(state_->mutex);
  state_->token = std::move(token);
}

void CoordinatorLink::open() {
  const auto stream = std::make_shared<Stream>(state_);
  {
    const core::MutexLock lock(state_->mutex);
    state_->stream = stream;
    ++state_->live;
  }
  stream->start();
}

void CoordinatorLink::send(v1::WorkerMessage message) {
  const core::MutexLock lock(state_->mutex);
  if (state_->stream) state_->stream->send(std::move(message));
}

bool CoordinatorLink::flowing() const {
  const core::MutexLock lock(state_->mutex);
  return state_->stream == nullptr || state_->stream->flowing();
}

void CoordinatorLink::finish() {
  const core::MutexLock lock(state_->mutex);
  if (state_->stream) state_->stream->finish();
}

}  // namespace hyades::worker
