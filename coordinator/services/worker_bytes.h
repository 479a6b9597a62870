#pragma once

#include <cstdint>
#include <optional>

#include <grpcpp/support/byte_buffer.h>

namespace hyades::coordinator {

/// How many bytes of a serialised WorkerMessage are not a result's film; nothing where it is not
/// such a message. Parses nothing: a message too long to be parsed safely can be told by it.
std::optional<uint64_t> bytes_besides_film(const grpc::ByteBuffer& message);

}  // namespace hyades::coordinator
