#pragma once

#include <cstdint>

#include <fmt/format.h>
#include <grpcpp/impl/codegen/proto_utils.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/status.h>

namespace hyades::farm {

// gRPC's limit on what is received is one for the whole server, and films are large; a parsed
// message of empty fields takes up to thirty times its bytes. So all services take bytes, and parse
// them only once the caller has been admitted and the message is known to be short enough.

/// Parses `bytes` into `message`; fields that its type does not have are dropped. INVALID_ARGUMENT
/// where they are more than `limit`, or no such message.
template <class Message>
grpc::Status parse(const grpc::ByteBuffer& bytes, uint64_t limit, Message& message) {
  if (bytes.Length() > limit) {
    // Not RESOURCE_EXHAUSTED: to come again would not help.
    return {grpc::StatusCode::INVALID_ARGUMENT,
            fmt::format("a message of {} bytes: {} are the most here", bytes.Length(), limit)};
  }
  grpc::ByteBuffer shared = bytes;  // a reference: parsing lets go of it
  if (!grpc::SerializationTraits<Message>::Deserialize(&shared, &message).ok()) {
    return {grpc::StatusCode::INVALID_ARGUMENT,
            fmt::format("these bytes are not a {}", message.GetTypeName())};
  }
  message.DiscardUnknownFields();
  return grpc::Status::OK;
}

/// Puts `message` as it goes over the wire into `bytes`, in place of what they held. INTERNAL where
/// it is too large for protobuf (2 GiB).
template <class Message>
grpc::Status serialise(const Message& message, grpc::ByteBuffer& bytes) {
  bytes.Clear();
  bool own = true;
  return grpc::SerializationTraits<Message>::Serialize(message, &bytes, &own);
}

}  // namespace hyades::farm
