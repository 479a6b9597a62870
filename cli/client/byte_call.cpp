#include "cli/client/byte_call.h"

#include <grpcpp/support/byte_buffer.h>

#include "farm/message_bytes.h"
#include "farm/part_count.h"
#include "farm/wire.h"

namespace hyades::cli {

ByteCall::ByteCall(const std::shared_ptr<grpc::Channel>& channel, grpc::ClientContext& context,
                   const std::string& method)
    : context_(context), stub_(channel) {
  call_ = stub_.PrepareCall(&context_, "/hyades.v1." + method, &queue_);
  call_->StartCall(this);
  (void)wait();  // a call that is broken already says so when it is read
}

bool ByteCall::wait() {
  void* tag = nullptr;
  bool well = false;
  return queue_.Next(&tag, &well) && well;
}

bool ByteCall::write(const google::protobuf::Message& message, bool last) {
  grpc::ByteBuffer bytes;
  if (!farm::serialise(message, bytes).ok()) return false;
  grpc::WriteOptions options;
  if (last) options.set_last_message();
  call_->Write(bytes, options, this);
  return wait();
}

void ByteCall::writes_done() {
  call_->WritesDone(this);
  (void)wait();
}

bool ByteCall::read(google::protobuf::Message& message) {
  grpc::ByteBuffer bytes;
  call_->Read(&bytes, this);
  if (!wait()) return false;
  // The code is one that is not tried again: to come again would not help.
  if (!farm::has_few_parts(bytes, *message.GetDescriptor(), farm::kMostParts)) {
    refused_ = {grpc::StatusCode::FAILED_PRECONDITION,
                "the coordinator sends a message of too many parts, or none that is known"};
  } else if (const grpc::Status read = farm::parse(bytes, farm::kMaxMessageBytes, message);
             !read.ok()) {
    refused_ = {grpc::StatusCode::FAILED_PRECONDITION,
                "the coordinator sends " + read.error_message()};
  }
  if (refused_.ok()) return true;
  cancel();
  return false;
}

void ByteCall::cancel() {
  context_.TryCancel();
  grpc::ByteBuffer bytes;
  do {
    bytes.Clear();
    call_->Read(&bytes, this);
  } while (wait());
}

grpc::Status ByteCall::finish() {
  grpc::Status status;
  call_->Finish(&status, this);
  (void)wait();
  return refused_.ok() ? status : refused_;
}

}  // namespace hyades::cli
