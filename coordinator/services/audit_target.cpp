#include "coordinator/services/audit_target.h"

#include <google/protobuf/descriptor.h>

namespace hyades::coordinator {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

constexpr size_t kMostBytes = 500;

/// A field that holds one number, text or message; as text.
std::string field_text(const Message& message, const char* name) {
  const FieldDescriptor* field = message.GetDescriptor()->FindFieldByName(name);
  if (field == nullptr || field->is_repeated()) return {};
  const auto* reflection = message.GetReflection();
  switch (field->cpp_type()) {
    case FieldDescriptor::CPPTYPE_UINT64: {
      const uint64_t number = reflection->GetUInt64(message, field);
      return number == 0 ? std::string() : std::to_string(number);
    }
    case FieldDescriptor::CPPTYPE_STRING:
      return reflection->GetString(message, field);
    case FieldDescriptor::CPPTYPE_MESSAGE:
      return reflection->HasField(message, field)
                 ? field_text(reflection->GetMessage(message, field), "id")
                 : std::string();
    default:
      return {};
  }
}

}  // namespace

std::string audit_target(const Message& request, const Message& response) {
  for (const Message* message : {&request, &response}) {
    for (const char* name : {"job", "worker", "id", "token"}) {
      if (std::string text = field_text(*message, name); !text.empty()) return text;
    }
  }
  return {};
}

std::string audit_detail(const Message& request) {
  return request.ByteSizeLong() > kMostBytes ? std::string() : request.ShortDebugString();
}

}  // namespace hyades::coordinator
