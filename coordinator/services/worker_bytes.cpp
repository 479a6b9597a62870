#include "coordinator/services/worker_bytes.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/wire_format_lite.h>
#include <grpcpp/support/proto_buffer_reader.h>

#include "hyades/v1/work.pb.h"

namespace hyades::coordinator {
namespace {

using google::protobuf::internal::WireFormatLite;

constexpr uint32_t kResult = WireFormatLite::MakeTag(v1::WorkerMessage::kResultFieldNumber,
                                                     WireFormatLite::WIRETYPE_LENGTH_DELIMITED);
constexpr uint32_t kFilm = WireFormatLite::MakeTag(v1::UnitResult::kFilmFieldNumber,
                                                   WireFormatLite::WIRETYPE_LENGTH_DELIMITED);

/// Adds up the films of all fields of tag `inside`, or, where that is 0, of the fields right here.
bool add_films(google::protobuf::io::CodedInputStream& in, uint32_t inside, uint64_t& films) {
  for (;;) {
    const uint32_t tag = in.ReadTag();
    if (tag == 0) return in.ConsumedEntireMessage();
    if (tag == kFilm && inside == 0) {
      uint32_t size = 0;
      if (!in.ReadVarint32(&size) || !in.Skip(static_cast<int>(size))) return false;
      films += size;
    } else if (tag == inside) {
      uint32_t size = 0;
      if (!in.ReadVarint32(&size)) return false;
      const auto limit = in.PushLimit(static_cast<int>(size));
      if (!add_films(in, 0, films)) return false;
      in.PopLimit(limit);
    } else if (!WireFormatLite::SkipField(&in, tag)) {
      return false;
    }
  }
}

}  // namespace

std::optional<uint64_t> bytes_besides_film(const grpc::ByteBuffer& message) {
  grpc::ByteBuffer shared = message;  // a reference
  grpc::ProtoBufferReader reader(&shared);
  google::protobuf::io::CodedInputStream in(&reader);
  uint64_t films = 0;
  if (!add_films(in, kResult, films)) return std::nullopt;
  return message.Length() - films;
}

}  // namespace hyades::coordinator
