#include "coordinator/services/service.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <grpcpp/impl/codegen/server_callback_handlers.h>

#include "coordinator/access/caller.h"
#include "coordinator/controller/owner_connections.h"
#include "coordinator/controller/within_memory.h"
#include "coordinator/operations/ownership.h"
#include "coordinator/services/request_call.h"
#include "core/base/mutex.h"
#include "farm/byte_budget.h"
#include "farm/part_count.h"

namespace hyades::coordinator {
namespace {

using grpc::internal::CallbackBidiHandler;
using grpc::internal::CallbackClientStreamingHandler;

/// What a call takes besides the message that waits for its reader [bytes].
constexpr uint64_t kCallBytes = uint64_t{16} << 10U;

}  // namespace

/// A call that one message answers.
class Service::UnaryCall final : public RequestCall {
 public:
  UnaryCall(Service& service, const Operation& operation, Context& context)
      : RequestCall(context),
        service_(service),
        operation_(operation),
        work_(std::make_shared<Work>()) {
    grpc::Status admitted = service.admission_.check(context, operation.rule, work_->caller);
    if (admitted.ok()) {
      waiting_.emplace(service.waiting_, owner_of(work_->caller));
      if (!waiting_->try_hold(kCallBytes)) admitted = too_much_unread();
    }
    if (admitted.ok()) {
      ask(service.patience_);
    } else {
      Finish(admitted);
    }
  }

 private:
  /// What the operation works on, which may go on when the call is over.
  struct Work {
    Caller caller{};
    std::unique_ptr<Message> request{};  ///< once it has been read
  };

  void take() override {
    grpc::Status status = grpc::Status::OK;
    if (operation_.handle.has_memory()) {
      bool answered = false;
      status = within_memory([&] {
        const std::unique_ptr<Message> response(operation_.handle.response().New());
        grpc::Status read = read_request();
        answered = read.ok() && operation_.handle.answer(service_.at_, *work_->request, *response);
        if (answered) read = farm::serialise(*response, said_);
        return read;
      });
      if (answered && status.ok()) return respond();
    }
    farm::ThreadPool* executor = service_.executors_.of(operation_.runs);
    if (!status.ok()) {
      Finish(status);
    } else if (executor == nullptr) {
      proceed();
    } else if (!executor->submit([this] { proceed(); }, owner_of(work_->caller).name)) {
      Finish(crowded());
    }
  }

  void proceed() {
    LargeRequest large;
    if (!work_->request) {
      const grpc::Status read = within_memory([&] { return read_alone(large); });
      if (!read.ok()) return Finish(read);
    }
    const std::shared_ptr<Work> work = work_;
    carry_out(operation_, operation_.handle, service_.at_, *work->request, work->caller,
              [this, work](const grpc::Status& status, const Message& response) {
                const grpc::Status done = status.ok() ? farm::serialise(response, said_) : status;
                if (!done.ok()) return Finish(done);
                respond();
              });
  }

  grpc::Status read_request() {
    work_->request.reset(operation_.handle.request().New());
    return farm::parse(asked_, operation_.most_bytes, *work_->request);
  }
  /// Reads a request that may be large.
  grpc::Status read_alone(LargeRequest& large) {
    if (asked_.Length() > farm::kMaxRequestBytes && asked_.Length() <= operation_.most_bytes) {
      const grpc::Status admitted = large.admit(asked_.Length());
      if (!admitted.ok()) return admitted;
      const auto& type = *operation_.handle.request().GetDescriptor();
      if (!farm::has_few_parts(asked_, type, farm::kMostParts)) {
        return {grpc::StatusCode::INVALID_ARGUMENT,
                fmt::format("more than {} parts in one request, or no {}", farm::kMostParts,
                            type.name())};
      }
    }
    return read_request();
  }
  /// Sends said_, as soon as the caller reads it, and where there is room for it until then.
  void respond() {
    // Nobody asks for what was asked any more, and the answer may wait.
    asked_.Clear();
    work_.reset();
    if (!waiting_->try_hold(said_.Length() + kCallBytes)) {
      said_.Clear();
      return Finish(too_much_unread());
    }
    answer(said_, service_.patience_);
  }

  Service& service_;
  const Operation& operation_;
  std::shared_ptr<Work> work_;
  Bytes said_;
  std::optional<farm::ByteBudget::Share>
      waiting_;  ///< of the call and its answer, until it was read
};

/// A call that a stream answers.
class Service::StreamCall final : public RequestCall, public OutgoingCall {
 public:
  StreamCall(Service& service, const Rule& rule, const MakeRawStream& make, Context& context)
      : RequestCall(context), admission_(service.admission_), make_(make), context_(context) {
    grpc::Status refused = admission_.check(context, rule, caller_);
    counted_.emplace(service.waiting_, owner_of(caller_));
    if (refused.ok() && !counted_->try_hold(kCallBytes)) refused = too_much_unread();
    if (refused.ok()) entry_ = count_connection(service.at_.controller, caller_, refused);
    if (refused.ok()) {
      ask(service.patience_);
    } else {
      Finish(refused);
    }
  }

  void OnWriteDone(bool ok) override {
    counted_->hold(kCallBytes);
    stream_->written(ok);
  }
  void OnCancel() override {
    const core::MutexLock lock(mutex_);
    cancelled_ = true;
    if (begun_ != nullptr) begun_->cancel();
  }
  void OnDone() override {
    if (stream_ != nullptr) stream_->end();
    RequestCall::OnDone();
  }

  void write(const Bytes& message) override {
    const uint64_t bytes = message.Length() + stream_->bytes_ahead() + kCallBytes;
    if (!counted_->try_hold(bytes)) return Finish(too_much_unread());
    StartWrite(&message);
  }
  void finish(const grpc::Status& status) override { Finish(status); }

 private:
  void take() override {
    grpc::Status refused;
    stream_ = make_(context_, caller_, asked_, refused);
    if (stream_ == nullptr) return Finish(refused);
    stream_->guard(admission_, caller_);
    {
      const core::MutexLock lock(mutex_);
      begun_ = stream_;
      if (cancelled_) begun_->cancel();
    }
    stream_->begin(*this);
  }

  const Admission& admission_;
  const MakeRawStream& make_;
  Context& context_;
  Caller caller_;
  std::optional<farm::ByteBudget::Share> counted_;  ///< while a message is on its way
  std::unique_ptr<OwnerConnections::Entry> entry_;  ///< among the owner's
  OutgoingStream* stream_ = nullptr;
  core::Mutex mutex_;
  OutgoingStream* begun_ HYADES_GUARDED_BY(mutex_) = nullptr;  ///< stream_, for OnCancel()
  bool cancelled_ HYADES_GUARDED_BY(mutex_) = false;
};

Service::Service(Backend at, const Admission& admission, Executors& executors,
                 std::chrono::milliseconds patience, farm::ByteBudget& waiting)
    : at_(at),
      admission_(admission),
      executors_(executors),
      patience_(patience),
      waiting_(waiting) {
  for (const Operation& operation : all_operations()) {
    if (!operation.handle || *operation.method == '\0') continue;
    add(operation.method, Method::BIDI_STREAMING,
        new CallbackBidiHandler<Bytes, Bytes>([this, &operation](Context* context) {
          return new UnaryCall(*this, operation, *context);
        }));
  }
}

/// What the code that protoc makes does for each method (gRPC takes `handler`).
void Service::add(const char* method, Method::RpcType type,
                  grpc::internal::MethodHandler* handler) {
  const int index = static_cast<int>(names_.size());
  names_.push_back(std::string("/hyades.v1.") + method);
  AddMethod(new grpc::internal::RpcServiceMethod(names_.back().c_str(), type, nullptr));
  MarkMethodRawCallback(index, handler);
}

farm::ThreadPool& Service::pool_of(const char* method) {
  return *executors_.of(operation_of_method(method).runs);
}

void Service::add_raw_server_stream(const char* method, const MakeRawStream& make) {
  const Rule& rule = operation_of_method(method).rule;
  add(method, Method::BIDI_STREAMING,
      new CallbackBidiHandler<Bytes, Bytes>([this, &rule, make](Context* context) {
        return new StreamCall(*this, rule, make, *context);
      }));
}

void Service::add_client_stream(const char* method,
                                const MakeReactor<grpc::ServerReadReactor<Bytes>>& make,
                                const Message& response) {
  const Rule& rule = operation_of_method(method).rule;
  add(method, Method::CLIENT_STREAMING,
      new CallbackClientStreamingHandler<Bytes, Bytes>(
          [this, &rule, &response, make](Context* context, Bytes* said) {
            (void)farm::serialise(response, *said);
            Caller caller;
            const grpc::Status admitted = admission_.check(*context, rule, caller);
            return make(*context, caller, admitted);
          }));
}

void Service::add_bidi_stream(const char* method,
                              const MakeReactor<grpc::ServerBidiReactor<Bytes, Bytes>>& make) {
  const Rule& rule = operation_of_method(method).rule;
  add(method, Method::BIDI_STREAMING,
      new CallbackBidiHandler<Bytes, Bytes>([this, &rule, make](Context* context) {
        Caller caller;
        const grpc::Status admitted = admission_.check(*context, rule, caller);
        return make(*context, caller, admitted);
      }));
}

}  // namespace hyades::coordinator
