#include "coordinator/services/service.h"

#include <chrono>
#include <cstdint>
#include <mutex>
#include <utility>

#include <fmt/format.h>
#include <grpcpp/impl/codegen/server_callback_handlers.h>

#include "coordinator/services/part_count.h"

namespace hyades::coordinator {
namespace {

using grpc::internal::CallbackBidiHandler;
using grpc::internal::CallbackClientStreamingHandler;
using grpc::internal::CallbackServerStreamingHandler;
using grpc::internal::CallbackUnaryHandler;

/// Messages in one request; a job with as many files as it may have has about half of that.
constexpr uint64_t kMostContributors = 200'000;

}  // namespace

/// A call on its way, which is answered once.
struct Service::UnaryCall {
  const Operation& operation;
  const Bytes& asked;
  Bytes& said;
  grpc::ServerUnaryReactor* reactor;  ///< every DefaultReactor() makes it anew
  Caller caller{};
  std::unique_ptr<Message> request{};  ///< once it has been read

  grpc::Status read() {
    request.reset(operation.handle.request().New());
    return farm::parse(asked, operation.most_bytes, *request);
  }
  /// Reads a request that may be large; `alone` holds take_large_request() then.
  grpc::Status read_alone(std::unique_lock<std::mutex>& alone) {
    if (asked.Length() > farm::kMaxRequestBytes && asked.Length() <= operation.most_bytes) {
      alone = take_large_request();
      if (!alone) return another_is_large();
      const auto& type = *operation.handle.request().GetDescriptor();
      if (!has_few_parts(asked, type, kMostContributors)) {
        return {grpc::StatusCode::INVALID_ARGUMENT,
                fmt::format("more than {} parts in one request, or no {}", kMostContributors,
                            type.name())};
      }
    }
    return read();
  }
  void finish(const grpc::Status& status, const Message& response) const {
    reactor->Finish(status.ok() ? farm::serialise(response, said) : status);
  }
};

Service::Service(Backend at, const Admission& admission, Executors& executors)
    : at_(at), admission_(admission), executors_(executors) {
  for (const Operation& operation : all_operations()) {
    if (!operation.handle || *operation.method == '\0') continue;
    add(operation.method, Method::NORMAL_RPC,
        new CallbackUnaryHandler<Bytes, Bytes>(
            [this, &operation](Context* context, const Bytes* asked, Bytes* said) {
              return begin(operation, *context, *asked, *said);
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

void Service::add_raw_reader(
    const char* method,
    std::function<grpc::ServerWriteReactor<Bytes>*(Context*, const Bytes*)> begin) {
  add(method, Method::SERVER_STREAMING,
      new CallbackServerStreamingHandler<Bytes, Bytes>(std::move(begin)));
}

void Service::add_writer(const char* method,
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

void Service::add_talker(const char* method,
                         const MakeReactor<grpc::ServerBidiReactor<Bytes, Bytes>>& make) {
  const Rule& rule = operation_of_method(method).rule;
  add(method, Method::BIDI_STREAMING,
      new CallbackBidiHandler<Bytes, Bytes>([this, &rule, make](Context* context) {
        Caller caller;
        const grpc::Status admitted = admission_.check(*context, rule, caller);
        return make(*context, caller, admitted);
      }));
}

grpc::ServerUnaryReactor* Service::begin(const Operation& operation, Context& context,
                                         const Bytes& asked, Bytes& said) {
  auto* reactor = context.DefaultReactor();
  const auto call = std::make_shared<UnaryCall>(UnaryCall{operation, asked, said, reactor});
  grpc::Status status = admission_.check(context, operation.rule, call->caller);
  if (status.ok() && operation.handle.has_memory()) {
    bool answered = false;
    status = within_memory([&] {
      const std::unique_ptr<Message> response(operation.handle.response().New());
      grpc::Status read = call->read();
      answered = read.ok() && operation.handle.answer(at_, *call->request, *response);
      if (answered) call->finish(read, *response);
      return read;
    });
    if (answered && status.ok()) return reactor;
  }
  farm::ThreadPool* executor = executors_.of(operation.runs);
  if (!status.ok()) {
    reactor->Finish(status);
  } else if (executor == nullptr) {
    proceed(call);
  } else if (!executor->submit([this, call] { proceed(call); })) {
    reactor->Finish(crowded());
  }
  return reactor;
}

void Service::proceed(const std::shared_ptr<UnaryCall>& call) {
  std::unique_lock<std::mutex> alone;
  if (!call->request) {
    const grpc::Status read = within_memory([&] { return call->read_alone(alone); });
    if (!read.ok()) return call->reactor->Finish(read);
  }
  carry_out(call->operation, call->operation.handle, at_, *call->request, call->caller,
            [call](const grpc::Status& status, const Message& response) {
              call->finish(status, response);
            });
}

}  // namespace hyades::coordinator
