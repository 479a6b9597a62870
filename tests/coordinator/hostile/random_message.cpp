#include "tests/coordinator/hostile/random_message.h"

#include <array>

namespace hyades::test {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

constexpr int kDeepest = 4;

uint32_t below(Random& random, size_t n) { return random() % static_cast<uint32_t>(n); }

/// Numbers that are at the edge of something, or just any.
uint64_t number(Random& random) {
  static constexpr std::array<uint64_t, 10> kEdges{
      0, 1, 2, 16, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, INT64_MAX, 1ULL << 63U, UINT64_MAX};
  if (below(random, 3) > 0) return kEdges[below(random, kEdges.size())];
  return (uint64_t{random()} << 32U) | random();
}

std::string text(Random& random, bool bytes) {
  switch (below(random, 4)) {
    case 0:
      return "job.yaml";
    case 1:
      return std::string(bytes ? 32 : 20, static_cast<char>('a' + below(random, 26)));
    case 2:
      return bytes ? random_bytes(random, 300) : std::string(below(random, 300), 'x');
    default:
      return {};
  }
}

void fill(Random& random, Message& message, int depth);

void set(Random& random, Message& message, const FieldDescriptor& field, int depth) {
  const auto& reflection = *message.GetReflection();
  const bool many = field.is_repeated();
  const auto put = [&](auto add, auto assign, auto value) {
    many ? (reflection.*add)(&message, &field, value)
         : (reflection.*assign)(&message, &field, value);
  };
  using R = google::protobuf::Reflection;
  const uint64_t n = number(random);
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_INT32:
      return put(&R::AddInt32, &R::SetInt32, static_cast<int32_t>(n));
    case FieldDescriptor::CPPTYPE_INT64:
      return put(&R::AddInt64, &R::SetInt64, static_cast<int64_t>(n));
    case FieldDescriptor::CPPTYPE_UINT32:
      return put(&R::AddUInt32, &R::SetUInt32, static_cast<uint32_t>(n));
    case FieldDescriptor::CPPTYPE_UINT64:
      return put(&R::AddUInt64, &R::SetUInt64, n);
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return put(&R::AddDouble, &R::SetDouble, static_cast<double>(n));
    case FieldDescriptor::CPPTYPE_FLOAT:
      return put(&R::AddFloat, &R::SetFloat, static_cast<float>(n));
    case FieldDescriptor::CPPTYPE_BOOL:
      return put(&R::AddBool, &R::SetBool, n % 2 == 1);
    case FieldDescriptor::CPPTYPE_ENUM:
      return put(&R::AddEnumValue, &R::SetEnumValue, static_cast<int>(n % 5));
    case FieldDescriptor::CPPTYPE_STRING: {
      const std::string value = text(random, field.type() == FieldDescriptor::TYPE_BYTES);
      return many ? reflection.AddString(&message, &field, value)
                  : reflection.SetString(&message, &field, value);
    }
    case FieldDescriptor::CPPTYPE_MESSAGE:
      if (depth == kDeepest) return;
      fill(random,
           *(many ? reflection.AddMessage(&message, &field)
                  : reflection.MutableMessage(&message, &field)),
           depth + 1);
  }
}

void fill(Random& random, Message& message, int depth) {
  const auto& type = *message.GetDescriptor();
  for (int i = 0; i < type.field_count(); ++i) {
    const uint32_t times = below(random, 3);
    for (uint32_t k = 0; k < (type.field(i)->is_repeated() ? times : times / 2); ++k) {
      set(random, message, *type.field(i), depth);
    }
  }
}

}  // namespace

std::string random_bytes(Random& random, size_t most) {
  std::string bytes(below(random, most + 1), '\0');
  for (char& byte : bytes) byte = static_cast<char>(random());
  return bytes;
}

std::unique_ptr<Message> random_message(Random& random, const google::protobuf::Descriptor& type) {
  std::unique_ptr<Message> message(
      google::protobuf::MessageFactory::generated_factory()->GetPrototype(&type)->New());
  fill(random, *message, 0);
  return message;
}

std::string mutated(Random& random, std::string bytes) {
  for (uint32_t times = 1 + below(random, 4); times > 0 && !bytes.empty(); --times) {
    const size_t at = below(random, bytes.size());
    switch (below(random, 4)) {
      case 0:
        bytes[at] = static_cast<char>(random());
        break;
      case 1:
        bytes.erase(at, 1 + below(random, 8));
        break;
      case 2:
        bytes.insert(at, bytes.substr(at, 1 + below(random, 16)));
        break;
      default:
        bytes.resize(at);
    }
  }
  return bytes;
}

}  // namespace hyades::test
