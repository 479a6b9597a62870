#include "coordinator/operations/audit.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>

#include "coordinator/operations/operation.h"

namespace hyades::coordinator {
namespace {

using google::protobuf::FieldDescriptor;
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

void note_upload(AuditLog* log, const Caller& caller, const std::string& sha256, uint64_t size,
                 uint64_t begun) {
  if (log == nullptr) return;
  const std::string detail = begun == 0 ? fmt::format("{} bytes", size)
                                        : fmt::format("{} bytes, goes on from {}", size, begun);
  log->upload(caller, operation_of_method("Assets/Upload").rule.action, sha256, detail);
}

}  // namespace hyades::coordinator
