#pragma once

#include <chrono>
#include <memory>
#include <optional>

#include <grpcpp/alarm.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

namespace hyades::coordinator {

/// A call that begins with one message, and is admitted before it: gRPC takes the message in only
/// once it is asked for. To gRPC it is therefore a call of which both sides send a stream; callers
/// cannot tell the difference. Deletes itself.
class RequestCall : public grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer> {
 public:
  void OnReadDone(bool ok) final;
  void OnDone() override;

 protected:
  explicit RequestCall(grpc::CallbackServerContext& context);
  ~RequestCall() override;

  /// Asks for the message. Where it has not come after `patience`, the call ends with
  /// DEADLINE_EXCEEDED. Called once at most, before the method of the service returns.
  void ask(std::chrono::milliseconds patience);
  /// The message has come.
  virtual void take() = 0;
  /// Ends the call with this message, which stays as it is until then. Where nobody has read it
  /// after `patience`, the call is broken off. Called once at most, and not before take().
  void answer(const grpc::ByteBuffer& message, std::chrono::milliseconds patience);

  grpc::ByteBuffer asked_;  ///< once it has come

 private:
  class Patience;
  void wait(std::chrono::milliseconds time, std::shared_ptr<Patience> patience);

  grpc::CallbackServerContext& context_;
  std::shared_ptr<Patience> patience_;  ///< while something is waited for
  std::optional<grpc::Alarm> alarm_;
};

}  // namespace hyades::coordinator
