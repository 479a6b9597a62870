#include "farm/part_count.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/wire_format_lite.h>
#include <grpcpp/support/proto_buffer_reader.h>

namespace hyades::farm {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::internal::WireFormatLite;

constexpr int kDeepest = 20;  // no message of ours is half as deep

/// Takes the fields of one message off `left`; false where there are too many, or they are none.
bool count(google::protobuf::io::CodedInputStream& in, const Descriptor& type, uint64_t& left,
           int depth) {
  for (;;) {
    const uint32_t tag = in.ReadTag();
    if (tag == 0) return in.ConsumedEntireMessage();
    const FieldDescriptor* field = type.FindFieldByNumber(WireFormatLite::GetTagFieldNumber(tag));
    const bool sized =
        WireFormatLite::GetTagWireType(tag) == WireFormatLite::WIRETYPE_LENGTH_DELIMITED;
    const bool message =
        field != nullptr && sized && field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE;
    const bool text = field != nullptr && sized && field->is_repeated() && !field->is_packable();
    if ((field == nullptr || message || text) && left-- == 0) return false;
    if (!message) {
      if (!WireFormatLite::SkipField(&in, tag)) return false;
      continue;
    }
    uint32_t size = 0;
    if (depth == kDeepest || !in.ReadVarint32(&size)) return false;
    const auto limit = in.PushLimit(static_cast<int>(size));
    if (!count(in, *field->message_type(), left, depth + 1)) return false;
    in.PopLimit(limit);
  }
}

}  // namespace

bool has_few_parts(const grpc::ByteBuffer& bytes, const Descriptor& type, uint64_t most) {
  grpc::ByteBuffer shared = bytes;  // a reference
  grpc::ProtoBufferReader reader(&shared);
  google::protobuf::io::CodedInputStream in(&reader);
  return count(in, type, most, 0);
}

}  // namespace hyades::farm
