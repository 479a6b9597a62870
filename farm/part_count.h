#pragma once

#include <cstdint>

#include <google/protobuf/descriptor.h>
#include <grpcpp/support/byte_buffer.h>

namespace hyades::farm {

/// In one message that may be large; a job with as many files as it may have has about half of
/// that.
inline constexpr uint64_t kMostParts = 200'000;

/// Whether `bytes`, taken as a message of `type`, has at most `most` messages, repeated strings and
/// unknown fields at all depths. Parses nothing: two bytes of an empty message take seventy once
/// they are parsed. False too where it is no such message.
bool has_few_parts(const grpc::ByteBuffer& bytes, const google::protobuf::Descriptor& type,
                   uint64_t most);

}  // namespace hyades::farm
