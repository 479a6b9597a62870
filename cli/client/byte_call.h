#pragma once

#include <memory>
#include <string>

#include <google/protobuf/message.h>
#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>
#include <grpcpp/completion_queue.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/support/status.h>

namespace hyades::cli {

/// One call of any kind, by one thread. What answers it is looked at before it is parsed: two bytes
/// of an empty message take hundreds once they are, and a coordinator may be hostile.
class ByteCall {
 public:
  /// Begins to call a method of the wire, such as "Jobs/List". `context` outlives this.
  ByteCall(const std::shared_ptr<grpc::Channel>& channel, grpc::ClientContext& context,
           const std::string& method);

  /// Sends a message, with `last` the last one. False where the call is broken: finish() has why.
  bool write(const google::protobuf::Message& message, bool last);
  /// Tells that nothing more is sent.
  void writes_done();
  /// The next message that answers. False where none follows, or what came is refused.
  bool read(google::protobuf::Message& message);
  /// Breaks it off; what was under way is thrown away.
  void cancel();
  /// How it ended; once.
  grpc::Status finish();

 private:
  bool wait();

  grpc::ClientContext& context_;
  grpc::CompletionQueue queue_;
  grpc::GenericStub stub_;
  std::unique_ptr<grpc::GenericClientAsyncReaderWriter> call_;
  grpc::Status refused_;  ///< why an answer was not taken
};

}  // namespace hyades::cli
