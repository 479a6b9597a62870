#include "worker/coordinator_link.h"

#include <chrono>
#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <utility>

#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/support/byte_buffer.h>

#include "core/base/mutex.h"
#include "core/base/result.h"
#include "farm/channel.h"
#include "farm/message_bytes.h"
#include "farm/part_count.h"
#include "farm/wire.h"
#include "farm/wire_status.h"

namespace hyades::worker {
namespace {

constexpr const char* kMethod = "/hyades.v1.Work/Attend";

/// What `bytes` say, or why they are refused. Unparsed they are looked at first: a message of empty
/// fields takes thirty times its bytes.
core::Result<v1::CoordinatorMessage> parse(const grpc::ByteBuffer& bytes) {
  v1::CoordinatorMessage message;
  if (!farm::has_few_parts(bytes, *v1::CoordinatorMessage::descriptor(), farm::kMostParts)) {
    return core::Error{"the coordinator sent a message of too many parts, or none that is known"};
  }
  const grpc::Status read = farm::parse(bytes, farm::kMaxMessageBytes, message);
  if (!read.ok()) return core::Error{"the coordinator sent " + read.error_message()};
  return message;
}

StreamEnd meaning_of(const grpc::Status& status) {
  switch (status.error_code()) {
    case grpc::StatusCode::UNAUTHENTICATED:
      return StreamEnd::unknown;
    case grpc::StatusCode::PERMISSION_DENIED:
    case grpc::StatusCode::FAILED_PRECONDITION:
    case grpc::StatusCode::UNIMPLEMENTED:
      return StreamEnd::refused;
    case grpc::StatusCode::ALREADY_EXISTS:
      return StreamEnd::id_taken;
    default:
      return farm::is_unanswered(status) ? StreamEnd::unanswered : StreamEnd::broken;
  }
}

}  // namespace

struct CoordinatorLink::State {
  Listener* listener = nullptr;
  core::Mutex mutex;
  core::CondVar closed;
  std::string token HYADES_GUARDED_BY(mutex);
  std::shared_ptr<Stream> stream HYADES_GUARDED_BY(mutex);  ///< the one that is open
  /// Streams whose end the listener has not heard of.
  int live HYADES_GUARDED_BY(mutex) = 0;
};

/// One call. It keeps itself alive until gRPC is done with it.
class CoordinatorLink::Stream
    : public grpc::ClientBidiReactor<v1::WorkerMessage, grpc::ByteBuffer> {
 public:
  explicit Stream(std::shared_ptr<State> state) : state_(std::move(state)) {
    const core::MutexLock lock(state_->mutex);
    farm::prepare(context_, state_->token, std::chrono::milliseconds(0));
  }

  void start(const std::shared_ptr<grpc::Channel>& channel) {
    grpc::TemplatedGenericStub<v1::WorkerMessage, grpc::ByteBuffer> calls(channel);
    calls.PrepareBidiStreamingCall(&context_, kMethod, {}, this);
    AddHold();  // what begins outside of reactions; let go of when the stream is broken
    StartRead(&incoming_);
    StartCall();
  }

  void send(v1::WorkerMessage message) {
    const core::MutexLock lock(mutex_);
    if (broken_ || finishing_) return;
    outgoing_bytes_ += message.ByteSizeLong();
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

  void heard() {
    const core::MutexLock lock(mutex_);
    if (unheard_.empty()) return;
    unheard_bytes_ -= unheard_.front();
    unheard_.pop_front();
    read_next_locked();
  }

  void break_off(const std::string& reason) {
    const core::MutexLock lock(mutex_);
    break_off_locked(reason);
    read_next_locked();  // by which its end is noticed
  }

  void OnReadDone(bool ok) override {
    if (!ok) {
      {
        const core::MutexLock lock(mutex_);
        broken_ = true;
      }
      RemoveHold();
      return;
    }
    const size_t bytes = incoming_.Length();
    auto message = parse(incoming_);
    incoming_.Clear();
    {
      const core::MutexLock lock(mutex_);
      if (message) {
        unheard_.push_back(bytes);
        unheard_bytes_ += bytes;
      } else {
        break_off_locked(message.error().message);
      }
    }
    if (message) state_->listener->stream_says(std::move(*message));
    const core::MutexLock lock(mutex_);
    reading_ = false;
    read_next_locked();
  }

  void OnWriteDone(bool ok) override {
    const core::MutexLock lock(mutex_);
    writing_ = false;
    if (!ok) {  // a broken stream, which is noticed by reading
      outgoing_.clear();
      outgoing_bytes_ = 0;
    }
    if (!broken_) write_next_locked();
    read_next_locked();
  }

  void OnDone(const grpc::Status& status) override {
    const std::shared_ptr<State> state = state_;
    std::shared_ptr<Stream> self;
    std::string reason = status.ok() ? "it was closed" : status.error_message();
    StreamEnd end = meaning_of(status);
    {
      const core::MutexLock lock(mutex_);
      if (broken_off_) {
        reason = *broken_off_;
        end = StreamEnd::broken;
      }
    }
    {
      const core::MutexLock lock(state->mutex);
      self = std::move(state->stream);
      state->stream.reset();
    }
    state->listener->stream_ended(
        end, reason, std::chrono::milliseconds(farm::detail_of(status).retry_after_ms()));
    self.reset();  // this stream, and its part of the channel
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
      outgoing_bytes_ -= current_.ByteSizeLong();
      StartWrite(&current_);
    } else if (finishing_ && !half_closed_) {
      half_closed_ = true;
      StartWritesDone();
    }
  }

  void read_next_locked() HYADES_REQUIRES(mutex_) {
    const bool busy = unheard_.size() >= kMostUnheard || unheard_bytes_ >= kMostUnheardBytes ||
                      outgoing_.size() >= kMostQueued || outgoing_bytes_ >= kMostQueuedBytes;
    if (reading_ || broken_ || (busy && !broken_off_)) return;
    reading_ = true;
    StartRead(&incoming_);
  }

  void break_off_locked(const std::string& reason) HYADES_REQUIRES(mutex_) {
    if (broken_ || broken_off_) return;
    broken_off_ = reason;
    context_.TryCancel();
  }

  const std::shared_ptr<State> state_;
  grpc::ClientContext context_;
  grpc::ByteBuffer incoming_;  ///< the read in progress'

  mutable core::Mutex mutex_;
  std::deque<v1::WorkerMessage> outgoing_ HYADES_GUARDED_BY(mutex_);
  size_t outgoing_bytes_ HYADES_GUARDED_BY(mutex_) = 0;
  v1::WorkerMessage current_ HYADES_GUARDED_BY(mutex_);
  /// Bytes of the messages that the listener has before it.
  std::deque<size_t> unheard_ HYADES_GUARDED_BY(mutex_);
  size_t unheard_bytes_ HYADES_GUARDED_BY(mutex_) = 0;
  bool reading_ HYADES_GUARDED_BY(mutex_) = true;  ///< from start() on
  bool writing_ HYADES_GUARDED_BY(mutex_) = false;
  bool broken_ HYADES_GUARDED_BY(mutex_) = false;
  bool finishing_ HYADES_GUARDED_BY(mutex_) = false;
  bool half_closed_ HYADES_GUARDED_BY(mutex_) = false;
  std::optional<std::string> broken_off_ HYADES_GUARDED_BY(mutex_);  ///< by this side: why
};

CoordinatorLink::CoordinatorLink(std::string token, Listener& listener)
    : state_(std::make_shared<State>()) {
  state_->token = std::move(token);
  state_->listener = &listener;
}

CoordinatorLink::~CoordinatorLink() {
  const core::MutexLock lock(state_->mutex);
  if (state_->stream) state_->stream->break_off("this worker ends");
  while (state_->live > 0) state_->closed.wait(state_->mutex);
}

void CoordinatorLink::set_token(std::string token) {
  const core::MutexLock lock(state_->mutex);
  state_->token = std::move(token);
}

void CoordinatorLink::open(const std::shared_ptr<grpc::Channel>& channel) {
  const auto stream = std::make_shared<Stream>(state_);
  {
    const core::MutexLock lock(state_->mutex);
    state_->stream = stream;
    ++state_->live;
  }
  stream->start(channel);
}

void CoordinatorLink::send(v1::WorkerMessage message) {
  const core::MutexLock lock(state_->mutex);
  if (state_->stream) state_->stream->send(std::move(message));
}

void CoordinatorLink::heard() {
  const core::MutexLock lock(state_->mutex);
  if (state_->stream) state_->stream->heard();
}

void CoordinatorLink::break_off(const std::string& reason) {
  const core::MutexLock lock(state_->mutex);
  if (state_->stream) state_->stream->break_off(reason);
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
